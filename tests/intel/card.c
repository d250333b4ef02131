/* An Intel card that is not there, for Mesa's Vulkan driver ANV: buffers, and the kernel driver i915.
 *
 * Mesa's own intel_noop_drm_shim.c, included whole, describes the cards to compilers; it executes nothing at all.
 * ANV as a whole needs more: memory that starts as zeroes, a kernel that is silent about what it lacks, and the
 * values that the GPU's command streamer writes, because ANV waits for some of them.
 */

#include <errno.h>
#include <fcntl.h>

#define drm_shim_driver_init init_mesa_s_card
#include "intel_noop_drm_shim.c"
#undef drm_shim_driver_init

#include "card.h"
#include "util/simple_mtx.h"

/* What drm_shim/device.c has for all buffers together. */
#define ALL_BUFFERS (4ull << 30)
#define PAGE 4096

/* Of a later kernel than this Mesa's header describes. */
#define PARAM_HAS_CONTEXT_FREQ_HINT 59

void drm_shim_driver_init(void);
extern ioctl_fn_t core_ioctls[];

const struct intel_device_info *card_info = &i915.devinfo;
uint32_t card_id;

static simple_mtx_t lock = SIMPLE_MTX_INITIALIZER;
static ioctl_fn_t mesa_s_close;

void
card_lock(void)
{
   simple_mtx_lock(&lock);
}

void
card_unlock(void)
{
   simple_mtx_unlock(&lock);
}

static int
fail(int error)
{
   errno = error;
   return -1;
}

int
card_buffer_create(int fd, uint64_t size, uint32_t *handle)
{
   struct i915_bo *bo = calloc(1, sizeof(*bo));
   uint64_t whole = (size + PAGE - 1) / PAGE * PAGE;
   /* Mesa's shim takes no notice if there is no room. */
   if (!bo || !size || whole > UINT32_MAX || drm_shim_bo_init(&bo->base, whole)) {
      free(bo);
      return fail(size ? ENOMEM : EINVAL);
   }
   *handle = drm_shim_bo_get_handle(drm_shim_fd_lookup(fd), &bo->base);
   drm_shim_bo_put(&bo->base);
   return 0;
}

int
card_buffer_offset(int fd, uint32_t handle, uint64_t *offset)
{
   struct shim_fd *shim = drm_shim_fd_lookup(fd);
   struct shim_bo *bo = drm_shim_bo_lookup(shim, handle);
   if (!bo)
      return fail(ENOENT);
   *offset = drm_shim_bo_get_mmap_offset(shim, bo);
   drm_shim_bo_put(bo);
   return 0;
}

/* The memory of all buffers, mapped when it is first needed: the library is loaded into every program that a sample
 * starts, and one that compiles shaders may not have so many addresses. */
static char *
map_all(void)
{
   static char *all;
   if (!all) {
      all = mmap(NULL, ALL_BUFFERS, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE, shim_device.mem_fd, 0);
      if (all == MAP_FAILED) {
         fprintf(stderr, "intel card: no room for its memory\n");
         _exit(1);
      }
   }
   return all;
}

char *
card_buffer(int fd, uint32_t handle, uint64_t *size)
{
   struct shim_bo *bo = drm_shim_bo_lookup(drm_shim_fd_lookup(fd), handle);
   if (!bo)
      return NULL;
   *size = bo->size;
   uint64_t at = bo->mem_addr;
   drm_shim_bo_put(bo);
   return map_all() + at;
}

/* A kernel gives zeroes, so the next buffer in this place must find them. */
static void
forget(struct shim_bo *bo)
{
   fallocate(shim_device.mem_fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, bo->mem_addr, bo->size);
}

static int
close_buffer(int fd, unsigned long request, void *arg)
{
   card_lock();
   int result = mesa_s_close(fd, request, arg);
   card_unlock();
   return result;
}

/* Nothing is shared with other devices. */
static int
share(int fd, unsigned long request, void *arg)
{
   return fail(ENOSYS);
}

static int
create(int fd, unsigned long request, void *arg)
{
   struct drm_i915_gem_create *create = arg;
   card_lock();
   int result = card_buffer_create(fd, create->size, &create->handle);
   card_unlock();
   return result;
}

static int
create_ext(int fd, unsigned long request, void *arg)
{
   struct drm_i915_gem_create_ext *create = arg;
   card_lock();
   int result = card_buffer_create(fd, create->size, &create->handle);
   card_unlock();
   return result;
}

static int
userptr(int fd, unsigned long request, void *arg)
{
   struct drm_i915_gem_userptr *user = arg;
   card_lock();
   int result = card_buffer_create(fd, user->user_size, &user->handle);
   card_unlock();
   return result;
}

static int
mmap_offset(int fd, unsigned long request, void *arg)
{
   struct drm_i915_gem_mmap_offset *mapped = arg;
   uint64_t offset = 0;
   card_lock();
   int result = card_buffer_offset(fd, mapped->handle, &offset);
   card_unlock();
   mapped->offset = offset;
   return result;
}

/* Kernels differ in what they have, and drivers ask; Mesa's shim writes a line of each question it does not know. */
static int
get_param(int fd, unsigned long request, void *arg)
{
   drm_i915_getparam_t *asked = arg;
   if (asked->param == I915_PARAM_PXP_STATUS || asked->param == PARAM_HAS_CONTEXT_FREQ_HINT)
      return fail(ENODEV);
   return i915_ioctl_get_param(fd, request, arg);
}

static int
query(int fd, unsigned long request, void *arg)
{
   struct drm_i915_query *query = arg;
   struct drm_i915_query_item *item = (void *)(uintptr_t)query->items_ptr;
   bool lacks = query->num_items == 1 && (item->query_id == DRM_I915_QUERY_HWCONFIG_BLOB ||
                                          item->query_id == DRM_I915_QUERY_GUC_SUBMISSION_VERSION);
   if (!lacks)
      return i915_ioctl_query(fd, request, arg);
   item->length = -ENODEV;
   return 0;
}

static int
execute(int fd, unsigned long request, void *arg)
{
   struct drm_i915_gem_execbuffer2 *exec = arg;
   struct drm_i915_gem_exec_object2 *objects = (void *)(uintptr_t)exec->buffers_ptr;
   struct ranges ranges = {};
   if (!exec->buffer_count)
      return 0;
   card_lock();
   for (uint32_t i = 0; i < exec->buffer_count; i++) {
      uint64_t size;
      char *memory = card_buffer(fd, objects[i].handle, &size);
      if (memory)
         streamer_add(&ranges, 0, objects[i].offset, size, memory);
   }
   uint32_t first = exec->flags & I915_EXEC_BATCH_FIRST ? 0 : exec->buffer_count - 1;
   streamer_run(&ranges, 0, objects[first].offset + exec->batch_start_offset);
   card_unlock();
   free(ranges.all);
   return 0;
}

void
drm_shim_driver_init(void)
{
   init_mesa_s_card();
   card_id = i915.device_id;
   shim_device.driver_bo_free = forget;

   mesa_s_close = core_ioctls[_IOC_NR(DRM_IOCTL_GEM_CLOSE)];
   core_ioctls[_IOC_NR(DRM_IOCTL_GEM_CLOSE)] = close_buffer;
   core_ioctls[_IOC_NR(DRM_IOCTL_PRIME_HANDLE_TO_FD)] = share;

   driver_ioctls[DRM_I915_GETPARAM] = get_param;
   driver_ioctls[DRM_I915_QUERY] = query;
   driver_ioctls[DRM_I915_GEM_CREATE] = create;
   driver_ioctls[DRM_I915_GEM_CREATE_EXT] = create_ext;
   driver_ioctls[DRM_I915_GEM_USERPTR] = userptr;
   driver_ioctls[DRM_I915_GEM_MMAP_GTT] = mmap_offset;
   driver_ioctls[DRM_I915_GEM_EXECBUFFER2] = execute;
   /* i915 does not drive Lunar Lake, Battlemage and what came after them. */
   if (card_info->ver >= 20)
      xe_install();
}
