/* The kernel driver xe, which Lunar Lake, Battlemage and newer cards have in place of i915: its calls as ANV makes
 * them (include/drm-uapi/xe_drm.h). Addresses are bound once and kept, instead of listed with each submission.
 */

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "card.h"
#include "dev/intel_hwconfig_types.h"
#include "drm-shim/drm_shim.h"
#include "drm-uapi/xe_drm.h"
#include "util/macros.h"

/* Of a later kernel than this Mesa's header describes. */
#define QUERY_PXP_STATUS 9

#define MEMORY (4ull << 30)
#define LARGE_PAGE 65536
#define SMALL_PAGE 4096

static struct ranges bound;
static uint32_t spaces;

static int
fail(int error)
{
   errno = error;
   return -1;
}

/* A description, as long as its parts make it. */
struct description {
   uint32_t size;
   char bytes[1024];
};

static void
add(struct description *to, const void *bytes, uint32_t size)
{
   if (to->size + size > sizeof(to->bytes))
      abort();
   memcpy(to->bytes + to->size, bytes, size);
   to->size += size;
}

static void
add_engines(struct description *to)
{
   static const uint16_t classes[] = {
      DRM_XE_ENGINE_CLASS_RENDER,
      DRM_XE_ENGINE_CLASS_COPY,
      DRM_XE_ENGINE_CLASS_COMPUTE,
   };
   struct drm_xe_query_engines head = { .num_engines = ARRAY_SIZE(classes) };
   add(to, &head, sizeof(head));
   for (uint32_t i = 0; i < ARRAY_SIZE(classes); i++) {
      struct drm_xe_engine engine = { .instance.engine_class = classes[i] };
      add(to, &engine, sizeof(engine));
   }
}

static void
add_memory(struct description *to)
{
   struct drm_xe_query_mem_regions head = { .num_mem_regions = card_info->has_local_mem ? 2 : 1 };
   add(to, &head, sizeof(head));
   struct drm_xe_mem_region host = {
      .mem_class = DRM_XE_MEM_REGION_CLASS_SYSMEM,
      .min_page_size = SMALL_PAGE,
      .total_size = MEMORY,
   };
   struct drm_xe_mem_region own = {
      .mem_class = DRM_XE_MEM_REGION_CLASS_VRAM,
      .instance = 1,
      .min_page_size = LARGE_PAGE,
      .total_size = MEMORY,
      .cpu_visible_size = MEMORY,
   };
   add(to, &host, sizeof(host));
   if (card_info->has_local_mem)
      add(to, &own, sizeof(own));
}

static void
add_config(struct description *to)
{
   bool own = card_info->has_local_mem;
   const uint64_t info[] = {
      [DRM_XE_QUERY_CONFIG_REV_AND_DEVICE_ID] = card_id,
      [DRM_XE_QUERY_CONFIG_FLAGS] = own ? DRM_XE_QUERY_CONFIG_FLAG_HAS_VRAM : 0,
      [DRM_XE_QUERY_CONFIG_MIN_ALIGNMENT] = own ? LARGE_PAGE : SMALL_PAGE,
      [DRM_XE_QUERY_CONFIG_VA_BITS] = 48,
      [DRM_XE_QUERY_CONFIG_MAX_EXEC_QUEUE_PRIORITY] = 1,
   };
   struct drm_xe_query_config head = { .num_params = ARRAY_SIZE(info) };
   add(to, &head, sizeof(head));
   add(to, info, sizeof(info));
}

static void
add_gts(struct description *to)
{
   struct drm_xe_query_gt_list head = { .num_gt = 1 };
   struct drm_xe_gt gt = {
      .type = DRM_XE_QUERY_GT_TYPE_MAIN,
      .reference_clock = card_info->timestamp_frequency,
      .near_mem_regions = card_info->has_local_mem ? 2 : 1,
      .far_mem_regions = card_info->has_local_mem ? 1 : 0,
      /* Battlemage is 20.1 and Lunar Lake 20.4; both were sold in revision 4. */
      .ip_ver_major = card_info->verx10 / 10,
      .ip_ver_minor = card_info->platform == INTEL_PLATFORM_BMG   ? 1
                      : card_info->platform == INTEL_PLATFORM_LNL ? 4
                                                                  : 0,
      .ip_ver_rev = 4,
   };
   add(to, &head, sizeof(head));
   add(to, &gt, sizeof(gt));
}

static void
add_mask(struct description *to, uint16_t type, uint64_t mask)
{
   struct drm_xe_query_topology_mask head = { .type = type, .num_bytes = sizeof(mask) };
   add(to, &head, sizeof(head));
   add(to, &mask, sizeof(mask));
}

static void
add_topology(struct description *to)
{
   uint32_t cores = 0;
   for (uint32_t slice = 0; slice < card_info->num_slices; slice++)
      cores += card_info->num_subslices[slice];
   add_mask(to, DRM_XE_TOPO_DSS_GEOMETRY, (1ull << cores) - 1);
   add_mask(to, DRM_XE_TOPO_DSS_COMPUTE, (1ull << cores) - 1);
   add_mask(to, DRM_XE_TOPO_L3_BANK, 0xf);
   if (card_info->ver >= 20)
      add_mask(to, DRM_XE_TOPO_SIMD16_EU_PER_DSS, 0xff);
   else
      add_mask(to, DRM_XE_TOPO_EU_PER_DSS, 0xffff);
}

/* Mesa 26 refuses a card without this table: pairs of a name and a value, each with its length in words. */
static void
add_hwconfig(struct description *to)
{
   const uint32_t table[][3] = {
      { INTEL_HWCONFIG_MAX_SLICES_SUPPORTED, 1, 8 },
      { INTEL_HWCONFIG_MAX_DUAL_SUBSLICES_SUPPORTED, 1, 32 },
      { INTEL_HWCONFIG_MAX_SUBSLICE, 1, 32 },
      { INTEL_HWCONFIG_MAX_NUM_EU_PER_DSS, 1, card_info->ver >= 20 ? 8 : 16 },
      { INTEL_HWCONFIG_NUM_THREADS_PER_EU, 1, 8 },
   };
   add(to, table, sizeof(table));
}

static int
tell_time(struct drm_xe_device_query *query)
{
   struct drm_xe_query_engine_cycles *cycles = (void *)(uintptr_t)query->data;
   if (!query->size) {
      query->size = sizeof(*cycles);
      return 0;
   }
   struct timespec now;
   clock_gettime(cycles->clockid, &now);
   cycles->width = 64;
   cycles->engine_cycles = streamer_time();
   cycles->cpu_timestamp = now.tv_sec * 1000000000ull + now.tv_nsec;
   cycles->cpu_delta = 100;
   return 0;
}

static int
device_query(int fd, unsigned long request, void *arg)
{
   struct drm_xe_device_query *query = arg;
   struct description told = {};
   switch (query->query) {
   case DRM_XE_DEVICE_QUERY_ENGINES:
      add_engines(&told);
      break;
   case DRM_XE_DEVICE_QUERY_MEM_REGIONS:
      add_memory(&told);
      break;
   case DRM_XE_DEVICE_QUERY_CONFIG:
      add_config(&told);
      break;
   case DRM_XE_DEVICE_QUERY_GT_LIST:
      add_gts(&told);
      break;
   case DRM_XE_DEVICE_QUERY_GT_TOPOLOGY:
      add_topology(&told);
      break;
   case DRM_XE_DEVICE_QUERY_HWCONFIG:
      add_hwconfig(&told);
      break;
   case DRM_XE_DEVICE_QUERY_UC_FW_VERSION: {
      struct drm_xe_query_uc_fw_version version = { .major_ver = 1, .minor_ver = 15 };
      add(&told, &version, sizeof(version));
      break;
   }
   case DRM_XE_DEVICE_QUERY_ENGINE_CYCLES:
      return tell_time(query);
   case DRM_XE_DEVICE_QUERY_OA_UNITS:
   case QUERY_PXP_STATUS:
      return fail(ENODEV);
   default:
      fprintf(stderr, "intel card: unknown query %u of xe\n", query->query);
      return fail(ENODEV);
   }
   if (query->size && query->size != told.size)
      return fail(EINVAL);
   if (query->size)
      memcpy((void *)(uintptr_t)query->data, told.bytes, told.size);
   query->size = told.size;
   return 0;
}

static int
gem_create(int fd, unsigned long request, void *arg)
{
   struct drm_xe_gem_create *create = arg;
   card_lock();
   int result = card_buffer_create(fd, create->size, &create->handle);
   card_unlock();
   return result;
}

static int
gem_mmap_offset(int fd, unsigned long request, void *arg)
{
   struct drm_xe_gem_mmap_offset *mapped = arg;
   uint64_t offset = 0;
   card_lock();
   int result = card_buffer_offset(fd, mapped->handle, &offset);
   card_unlock();
   mapped->offset = offset;
   return result;
}

static int
vm_create(int fd, unsigned long request, void *arg)
{
   struct drm_xe_vm_create *create = arg;
   card_lock();
   create->vm_id = ++spaces;
   card_unlock();
   return 0;
}

static int
vm_destroy(int fd, unsigned long request, void *arg)
{
   struct drm_xe_vm_destroy *destroy = arg;
   card_lock();
   streamer_remove(&bound, destroy->vm_id, 0, 1ull << 48);
   card_unlock();
   return 0;
}

static int
vm_bind(int fd, unsigned long request, void *arg)
{
   struct drm_xe_vm_bind *bind = arg;
   struct drm_xe_vm_bind_op *ops = bind->num_binds == 1 ? &bind->bind : (void *)(uintptr_t)bind->vector_of_binds;
   card_lock();
   for (uint32_t i = 0; i < bind->num_binds; i++) {
      struct drm_xe_vm_bind_op *op = &ops[i];
      uint64_t size;
      if (op->op == DRM_XE_VM_BIND_OP_UNMAP_ALL) {
         /* All of one buffer, wherever it is bound. */
         char *memory = card_buffer(fd, op->obj, &size);
         for (uint32_t r = bound.count; memory && r-- > 0;) {
            struct range *range = &bound.all[r];
            if (range->space == bind->vm_id && range->memory >= memory && range->memory < memory + size)
               *range = bound.all[--bound.count];
         }
      } else if (op->op != DRM_XE_VM_BIND_OP_PREFETCH) {
         streamer_remove(&bound, bind->vm_id, op->addr, op->range);
      }
      if (op->op == DRM_XE_VM_BIND_OP_MAP_USERPTR) {
         streamer_add(&bound, bind->vm_id, op->addr, op->range, (char *)(uintptr_t)op->userptr);
      } else if (op->op == DRM_XE_VM_BIND_OP_MAP && op->obj) {
         char *memory = card_buffer(fd, op->obj, &size);
         if (memory)
            streamer_add(&bound, bind->vm_id, op->addr, op->range, memory + op->obj_offset);
      }
   }
   card_unlock();
   return 0;
}

/* A queue is known by its address space, which is all that differs between two of them. */
static int
exec_queue_create(int fd, unsigned long request, void *arg)
{
   struct drm_xe_exec_queue_create *create = arg;
   create->exec_queue_id = create->vm_id;
   return 0;
}

static int
exec_queue_get_property(int fd, unsigned long request, void *arg)
{
   struct drm_xe_exec_queue_get_property *property = arg;
   property->value = 0; /* not banned */
   return 0;
}

static int
exec(int fd, unsigned long request, void *arg)
{
   struct drm_xe_exec *exec = arg;
   if (exec->num_batch_buffer != 1)
      return 0;
   card_lock();
   streamer_run(&bound, exec->exec_queue_id, exec->address);
   card_unlock();
   return 0;
}

static int
done(int fd, unsigned long request, void *arg)
{
   return 0;
}

void
xe_install(void)
{
   static ioctl_fn_t calls[] = {
      [DRM_XE_DEVICE_QUERY] = device_query,
      [DRM_XE_GEM_CREATE] = gem_create,
      [DRM_XE_GEM_MMAP_OFFSET] = gem_mmap_offset,
      [DRM_XE_VM_CREATE] = vm_create,
      [DRM_XE_VM_DESTROY] = vm_destroy,
      [DRM_XE_VM_BIND] = vm_bind,
      [DRM_XE_EXEC_QUEUE_CREATE] = exec_queue_create,
      [DRM_XE_EXEC_QUEUE_DESTROY] = done,
      [DRM_XE_EXEC_QUEUE_GET_PROPERTY] = exec_queue_get_property,
      [DRM_XE_EXEC] = exec,
      [DRM_XE_WAIT_USER_FENCE] = done,
   };
   shim_device.driver_name = "xe";
   shim_device.driver_ioctls = calls;
   shim_device.driver_ioctl_count = ARRAY_SIZE(calls);
   shim_device.version_major = 1;
   shim_device.version_minor = 1;
}
