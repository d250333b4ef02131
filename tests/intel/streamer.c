/* What a GPU's command streamer writes by itself: the results of queries, times, and copies of single words.
 *
 * ANV waits for such values: a query is available once its flag is written, and a device whose flag is never
 * written is lost. The commands are Intel's, from the Programmer's Reference Manuals and Mesa's genxml. Nothing that
 * a shader would write is written: what is traced, built or drawn stays as it was.
 */

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "card.h"

/* Addresses have 48 bits; the rest repeats the highest. */
#define ADDRESS(value) ((value) & 0xffffffffffffull)
/* A submission of a chapter has some thousand commands: one without an end is a mistake of this file. */
#define MOST_COMMANDS 20000000
/* Batches call each other so deep at most. */
#define MOST_CALLS 8

/* Opcodes of the memory interface, bits 23 to 28 of a command of type 0. */
enum {
   FIRST_WITH_LENGTH = 0x10,
   BATCH_BUFFER_END = 0x0a,
   STORE_DATA_IMM = 0x20,
   STORE_REGISTER_MEM = 0x24,
   FLUSH_DW = 0x26,
   COPY_MEM_MEM = 0x2e,
   BATCH_BUFFER_START = 0x31,
};

/* The upper halves of two commands of the pipelines. */
enum {
   PIPE_CONTROL = 0x7a00,
   VF_STATISTICS = 0x780b,
};

/* The time's two words among the registers of each engine. */
enum { REGISTERS_OF_ENGINE = 0xfff, TIME_LOW = 0x358, TIME_HIGH = 0x35c };

/* What FLUSH_DW and PIPE_CONTROL write after all is done, two bits. */
enum { WRITE_NOTHING, WRITE_VALUE, WRITE_DEPTH_COUNT, WRITE_TIME };

uint64_t
streamer_time(void)
{
   struct timespec now;
   clock_gettime(CLOCK_MONOTONIC, &now);
   uint64_t frequency = card_info->timestamp_frequency;
   return now.tv_sec * frequency + (uint64_t)now.tv_nsec * frequency / 1000000000;
}

void
streamer_add(struct ranges *ranges, uint32_t space, uint64_t address, uint64_t size, char *memory)
{
   if (ranges->count == ranges->room) {
      ranges->room = ranges->room ? 2 * ranges->room : 64;
      ranges->all = realloc(ranges->all, ranges->room * sizeof(*ranges->all));
      if (!ranges->all)
         abort();
   }
   uint64_t start = ADDRESS(address);
   ranges->all[ranges->count++] = (struct range){ start, start + size, memory, space };
}

/* Removes what lies within; a driver unmaps what it has mapped, whole. */
void
streamer_remove(struct ranges *ranges, uint32_t space, uint64_t address, uint64_t size)
{
   uint64_t start = ADDRESS(address), end = start + size;
   uint32_t kept = 0;
   for (uint32_t i = 0; i < ranges->count; i++) {
      struct range range = ranges->all[i];
      if (range.space != space || range.start < start || range.end > end)
         ranges->all[kept++] = range;
   }
   ranges->count = kept;
}

static char *
at(const struct ranges *ranges, uint32_t space, uint64_t address, uint64_t size)
{
   address = ADDRESS(address);
   for (uint32_t i = ranges->count; i-- > 0;) {
      const struct range *range = &ranges->all[i];
      if (range->space == space && range->start <= address && address + size <= range->end)
         return range->memory + (address - range->start);
   }
   return NULL;
}

static void
put(const struct ranges *ranges, uint32_t space, uint64_t address, uint64_t value, uint32_t size)
{
   char *memory = at(ranges, space, address, size);
   if (memory)
      memcpy(memory, &value, size);
}

/* A command's length in words; 0 if it is none. */
static uint32_t
words(uint32_t head)
{
   uint32_t told = (head & 0xff) + 2;
   switch (head >> 29) {
   case 0:
      return ((head >> 23) & 0x3f) < FIRST_WITH_LENGTH ? 1 : told;
   case 2: /* copies */
   case 5: /* barriers of newer cards */
      return told;
   case 3: /* of the pipelines: those that have no length are switches */
      return ((head >> 27) & 3) == 1 || head >> 16 == VF_STATISTICS ? 1 : told;
   default:
      return 0;
   }
}

static uint64_t
pair(const uint32_t *word)
{
   return word[0] | (uint64_t)word[1] << 32;
}

/* The writes of a command of the memory interface. */
static void
store(const struct ranges *ranges, uint32_t space, const uint32_t *word, uint32_t count)
{
   switch ((word[0] >> 23) & 0x3f) {
   case STORE_DATA_IMM:
      put(ranges, space, pair(word + 1) & ~3ull, word[0] & 1 << 21 ? pair(word + 3) : word[3],
          word[0] & 1 << 21 ? 8 : 4);
      break;
   case STORE_REGISTER_MEM: {
      /* Of all registers only the time goes on by itself. */
      uint32_t which = word[1] & REGISTERS_OF_ENGINE & ~3u;
      uint64_t time = which == TIME_LOW || which == TIME_HIGH ? streamer_time() : 0;
      put(ranges, space, pair(word + 2) & ~3ull, which == TIME_HIGH ? time >> 32 : time, 4);
      break;
   }
   case COPY_MEM_MEM: {
      char *from = at(ranges, space, pair(word + 3) & ~3ull, 4);
      uint32_t value = 0;
      if (from)
         memcpy(&value, from, 4);
      put(ranges, space, pair(word + 1) & ~3ull, value, 4);
      break;
   }
   case FLUSH_DW: {
      uint32_t what = count < 5 ? WRITE_NOTHING : word[0] >> 14 & 3;
      if (what == WRITE_VALUE || what == WRITE_TIME)
         put(ranges, space, pair(word + 1) & ~7ull, what == WRITE_TIME ? streamer_time() : pair(word + 3), 8);
      break;
   }
   }
}

static void
pipe_control(const struct ranges *ranges, uint32_t space, const uint32_t *word)
{
   uint32_t what = word[1] >> 14 & 3;
   uint64_t value = what == WRITE_VALUE ? pair(word + 4) : what == WRITE_TIME ? streamer_time() : 0;
   if (what != WRITE_NOTHING)
      put(ranges, space, pair(word + 2) & ~7ull, value, 8);
}

void
streamer_run(const struct ranges *ranges, uint32_t space, uint64_t batch)
{
   uint64_t calls[MOST_CALLS];
   uint32_t depth = 0;
   for (uint32_t done = 0; done < MOST_COMMANDS; done++) {
      const uint32_t *word = (const uint32_t *)at(ranges, space, batch, 4);
      uint32_t count = word ? words(word[0]) : 0;
      if (!count || !at(ranges, space, batch, 4ull * count)) {
         fprintf(stderr, "intel card: no command at %" PRIx64 ": %08x\n", batch, word ? word[0] : 0);
         return;
      }
      uint64_t next = batch + 4ull * count;
      if (word[0] >> 16 == PIPE_CONTROL) {
         pipe_control(ranges, space, word);
      } else if (word[0] >> 29 == 0) {
         switch (word[0] >> 23 & 0x3f) {
         case BATCH_BUFFER_END:
            if (!depth)
               return;
            next = calls[--depth];
            break;
         case BATCH_BUFFER_START:
            /* One with a predicate is a loop or a skip of indirect draws: never taken. */
            if (word[0] & 1 << 15)
               break;
            if (word[0] & 1 << 22) {
               if (depth == MOST_CALLS)
                  return;
               calls[depth++] = next;
            }
            next = pair(word + 1) & ~3ull;
            break;
         default:
            store(ranges, space, word, count);
         }
      }
      batch = next;
   }
   fprintf(stderr, "intel card: a submission without an end\n");
}
