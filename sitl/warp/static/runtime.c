// SPDX-License-Identifier: BSD-3-Clause
// Reads the clock page by system calls alone.
#include "runtime.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>

static struct warp_clock clock_;

int warp_attach(const char *path) {
  long fd = CALL(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC, 0);
  if (fd < 0) return 0;
  long at = CALL(SYS_mmap, 0, WARP_PAGE_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  CALL(SYS_close, fd);
  if (at < 0 && at > -4096) return 0;
  struct warp_page *page = (struct warp_page *)at;
  if (page->magic != WARP_MAGIC || page->bytes != WARP_PAGE_BYTES) return 0;
  CALL(SYS_prctl, PR_SET_TIMERSLACK, 1);
  warp_register(page, (int32_t)CALL(SYS_getpid, 0));
  clock_.page = page;
  return 1;
}

static int64_t now_on(struct warp_line *l, int64_t *wall_now) {
  *l = warp_read(clock_.page);
  struct timespec t;
  CALL(SYS_clock_gettime, CLOCK_MONOTONIC, &t);
  int64_t wall = from_spec(&t);
  if (warp_should_ask(&clock_, l, wall) && CALL(SYS_kill, clock_.page->writer, 0) == -ESRCH) clock_.orphaned_at = wall;
  *wall_now = wall;
  return warp_advance(&clock_, l, wall);
}

int64_t runtime_now(void) {
  struct warp_line l;
  int64_t wall_now;
  return now_on(&l, &wall_now);
}

int64_t runtime_wall_until(int64_t deadline) {
  struct warp_line l;
  int64_t wall_now;
  int64_t now = now_on(&l, &wall_now);
  return warp_look(&clock_, &l, wall_now, now, deadline);
}

int64_t runtime_wall_length(int64_t sim) {
  struct warp_line l;
  int64_t wall_now;
  int64_t now = now_on(&l, &wall_now);
  return warp_length(&clock_, &l, now, sim);
}

int64_t runtime_after(int64_t ns) {
  int64_t now = runtime_now();
  return ns > WARP_FOREVER - now ? WARP_FOREVER : now + ns;
}

static int64_t origin(clockid_t id) {
  int date = id == CLOCK_REALTIME || id == CLOCK_REALTIME_COARSE;
  return date ? clock_.page->epoch_ns : clock_.page->uptime_ns;
}

int64_t runtime_at(clockid_t id, const struct timespec *t) {
  int64_t ns = from_spec(t);
  return ns == WARP_FOREVER ? ns : ns - origin(id);
}

int runtime_is_warped(clockid_t id) {
  return id == CLOCK_REALTIME || id == CLOCK_MONOTONIC || id == CLOCK_MONOTONIC_RAW || id == CLOCK_REALTIME_COARSE ||
         id == CLOCK_MONOTONIC_COARSE || id == CLOCK_BOOTTIME;
}

int runtime_gettime(clockid_t id, struct timespec *out) {
  *out = to_spec(origin(id) + runtime_now());
  return 0;
}
