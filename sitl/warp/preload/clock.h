// SPDX-License-Identifier: BSD-3-Clause
// The preload library's own functions, for its other files.
#ifndef SITL_WARP_CLOCK_H
#define SITL_WARP_CLOCK_H

#include "line.h"

#include <stdint.h>
#include <sys/time.h>
#include <time.h>

// Simulated time now [ns]; never goes back within a process.
int64_t warp_now(void);
// 1 when a clock page is attached, else every function of this library is the C library's own.
int warp_active(void);
// Nanoseconds of wall time to wait before looking at the clock again, when it should reach `deadline_ns` (simulated).
int64_t warp_wall_until(int64_t deadline_ns);
// Nanoseconds of wall time that `sim_ns` of simulated time last at the present rate; at least 1.
int64_t warp_wall_length(int64_t sim_ns);
// Sets a timer of signals.c to a simulated deadline [ns] (0: stops it); 0 when `id` is none of those, else 1 and `result`.
int warp_set_signal_timer(timer_t id, int64_t deadline, int64_t interval, struct itimerspec *before, int *result);
struct timeval warp_wall_timeval(struct timeval sim);
// The same, the other way round.
int64_t warp_sim_length(int64_t wall_ns);
// 1 when the clock `id` follows the simulation (processor-time clocks do not).
int warp_is_warped(clockid_t id);
// Offset [ns] of clock `id` at simulated time zero.
int64_t warp_origin(clockid_t id);
// The clock an absolute deadline was meant for: dates after 2001 are CLOCK_REALTIME, small numbers an uptime.
clockid_t warp_clock_of(const struct timespec *deadline);

// Simulated deadline [ns] of "this long from now" and of "at this date of clock `id`".
int64_t warp_after(int64_t ns);
int64_t warp_at(clockid_t id, const struct timespec *deadline);

// The machine's own clock `id` [ns], not warped.
int64_t warp_real(clockid_t id);

static inline int64_t warp_from_spec(const struct timespec *t) {
  if (t->tv_sec >= 9000000000ll) return WARP_FOREVER;
  return (int64_t)t->tv_sec * WARP_SECOND + t->tv_nsec;
}

static inline struct timespec warp_to_spec(int64_t ns) {
  if (ns < 0) ns = 0;
  return (struct timespec){.tv_sec = ns / WARP_SECOND, .tv_nsec = ns % WARP_SECOND};
}

// The C library's own `name`; found once.
void *warp_next(const char *name);
#define WARP_REAL(result, name, ...)                                  \
  static result (*real_##name)(__VA_ARGS__);                         \
  if (__builtin_expect(!real_##name, 0)) real_##name = warp_next(#name)

#endif
