/* An Intel card that is not there: what the parts of the stand-in know of each other. */

#ifndef CARD_H
#define CARD_H

#include <stdbool.h>
#include <stdint.h>

#include "dev/intel_device_info.h"

/* Memory at an address of the GPU, in one address space of the process. */
struct range {
   uint64_t start, end;
   char *memory;
   uint32_t space;
};

/* The memory that one submission can reach, the last added first. */
struct ranges {
   struct range *all;
   uint32_t count, room;
};

/* card.c: the card of this process, and its buffers. Every call about buffers holds the lock, because the
 * reference counts of drm-shim are right for one caller at a time only. */
extern const struct intel_device_info *card_info;
extern uint32_t card_id;
void card_lock(void);
void card_unlock(void);
int card_buffer_create(int fd, uint64_t size, uint32_t *handle);
int card_buffer_offset(int fd, uint32_t handle, uint64_t *offset);
/* The buffer's bytes and size; null if there is no such buffer. */
char *card_buffer(int fd, uint32_t handle, uint64_t *size);

/* streamer.c: what the GPU's command streamer writes by itself. */
uint64_t streamer_time(void);
void streamer_add(struct ranges *ranges, uint32_t space, uint64_t address, uint64_t size, char *memory);
void streamer_remove(struct ranges *ranges, uint32_t space, uint64_t address, uint64_t size);
void streamer_run(const struct ranges *ranges, uint32_t space, uint64_t batch);

/* xe.c: the kernel driver of the newer cards. */
void xe_install(void);

#endif
