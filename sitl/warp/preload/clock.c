// SPDX-License-Identifier: BSD-3-Clause
// Reads the clock page and answers the calls that ask what time it is.
#define _GNU_SOURCE
#include "clock.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

static struct warp_clock clock_;

void *warp_next(const char *name) {
  void *f = NULL;
#if defined(__x86_64__) && defined(__GLIBC__)
  // Condition variables have two versions on x86-64; plain dlsym may give the pre-2002 one.
  if (!strncmp(name, "pthread_cond_", 13)) f = dlvsym(RTLD_NEXT, name, "GLIBC_2.3.2");
  if (!strncmp(name, "timer_", 6)) f = dlvsym(RTLD_NEXT, name, "GLIBC_2.3.3"); // and timers, with other numbers
#endif
  return f ? f : dlsym(RTLD_NEXT, name);
}

int64_t warp_real(clockid_t id) {
  WARP_REAL(int, clock_gettime, clockid_t, struct timespec *);
  struct timespec t = {0, 0};
  real_clock_gettime(id, &t);
  return warp_from_spec(&t);
}

static void register_process(void) { warp_register(clock_.page, (int32_t)getpid()); }

__attribute__((constructor)) static void attach(void) {
  const char *path = getenv("SITL_WARP_PAGE");
  if (!path || clock_.page) return;
  int fd = open(path, O_RDWR | O_CLOEXEC);
  if (fd < 0) return;
  struct warp_page *p = mmap(NULL, WARP_PAGE_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  close(fd);
  if (p == MAP_FAILED) return;
  if (p->magic != WARP_MAGIC || p->bytes != WARP_PAGE_BYTES) {
    munmap(p, WARP_PAGE_BYTES);
    return;
  }
  // The script of a command that is killed ends, too: what it talks to is gone.
  const char *parent = getenv("SITL_WARP_PARENT");
  if (parent && atoi(parent) == (int)getppid()) prctl(PR_SET_PDEATHSIG, SIGTERM, 0, 0, 0);
  // The kernel may end any wait 50 us late to save power: 5 ms of simulated time at 100x.
  prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0);
  clock_.page = p;
  register_process();
  pthread_atfork(NULL, NULL, register_process);
}

__attribute__((destructor)) static void detach(void) {
  for (int i = 0; clock_.page && i < WARP_PID_SLOTS; i++) {
    int32_t self = (int32_t)getpid();
    __atomic_compare_exchange_n(&clock_.page->pids[i], &self, 0, 0, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);
  }
}

int warp_active(void) { return clock_.page != NULL; }

// Gone, or a zombie whose parent has not collected it yet.
static int has_ended(pid_t pid) {
  if (kill(pid, 0) != 0) return errno == ESRCH;
  char path[32], stat[64] = "";
  snprintf(path, sizeof path, "/proc/%d/stat", (int)pid);
  int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return 0;
  ssize_t n = read(fd, stat, sizeof stat - 1);
  close(fd);
  const char *state = n > 0 ? strchr(stat, ')') : NULL;
  return state && state[1] == ' ' && state[2] == 'Z';
}

static int64_t now_on(struct warp_line *l, int64_t *wall_now) {
  int saved = errno;
  *l = warp_read(clock_.page);
  int64_t wall = warp_real(CLOCK_MONOTONIC);
  // A simulator that was killed can neither publish nor release the clock: from then on it runs at 1x.
  if (warp_should_ask(&clock_, l, wall) && has_ended((pid_t)clock_.page->writer)) clock_.orphaned_at = wall;
  errno = saved;
  *wall_now = wall;
  return warp_advance(&clock_, l, wall);
}

int64_t warp_now(void) {
  struct warp_line l;
  int64_t wall_now;
  return now_on(&l, &wall_now);
}

int64_t warp_wall_until(int64_t deadline) {
  struct warp_line l;
  int64_t wall_now;
  int64_t now = now_on(&l, &wall_now);
  return warp_look(&clock_, &l, wall_now, now, deadline);
}

int64_t warp_wall_length(int64_t sim) {
  struct warp_line l;
  int64_t wall_now;
  int64_t now = now_on(&l, &wall_now);
  return warp_length(&clock_, &l, now, sim);
}

int64_t warp_sim_length(int64_t wall) {
  struct warp_line l = warp_read(clock_.page);
  double rate = warp_rate(&clock_, &l);
  return rate <= 0.0 ? wall : (int64_t)((double)wall * rate);
}

int warp_is_warped(clockid_t id) {
  switch (id) {
  case CLOCK_REALTIME:
  case CLOCK_MONOTONIC:
  case CLOCK_MONOTONIC_RAW:
  case CLOCK_REALTIME_COARSE:
  case CLOCK_MONOTONIC_COARSE:
  case CLOCK_BOOTTIME:
  case CLOCK_TAI:
    return 1;
  default:
    return 0;
  }
}

int64_t warp_origin(clockid_t id) {
  if (id == CLOCK_REALTIME || id == CLOCK_REALTIME_COARSE) return clock_.page->epoch_ns;
  return id == CLOCK_TAI ? clock_.page->epoch_ns + 37 * WARP_SECOND : clock_.page->uptime_ns;
}

clockid_t warp_clock_of(const struct timespec *t) { return t->tv_sec > 1000000000ll ? CLOCK_REALTIME : CLOCK_MONOTONIC; }

int64_t warp_after(int64_t ns) {
  int64_t now = warp_now();
  return ns > WARP_FOREVER - now ? WARP_FOREVER : now + ns;
}

int64_t warp_at(clockid_t id, const struct timespec *t) {
  int64_t ns = warp_from_spec(t);
  return ns == WARP_FOREVER ? ns : ns - warp_origin(id);
}

int clock_gettime(clockid_t id, struct timespec *out) {
  WARP_REAL(int, clock_gettime, clockid_t, struct timespec *);
  if (!clock_.page || !warp_is_warped(id)) return real_clock_gettime(id, out);
  *out = warp_to_spec(warp_origin(id) + warp_now());
  return 0;
}

int gettimeofday(struct timeval *restrict out, void *restrict zone) {
  WARP_REAL(int, gettimeofday, struct timeval *, void *);
  if (!clock_.page) return real_gettimeofday(out, zone);
  int result = real_gettimeofday(out, zone); // fills the time zone
  struct timespec t = warp_to_spec(clock_.page->epoch_ns + warp_now());
  out->tv_sec = t.tv_sec;
  out->tv_usec = t.tv_nsec / 1000;
  return result;
}

time_t time(time_t *out) {
  struct timespec t;
  clock_gettime(CLOCK_REALTIME, &t);
  if (out) *out = t.tv_sec;
  return t.tv_sec;
}

int timespec_get(struct timespec *out, int base) {
  if (base != TIME_UTC) return 0;
  clock_gettime(CLOCK_REALTIME, out);
  return base;
}
