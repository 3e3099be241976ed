// SPDX-License-Identifier: BSD-3-Clause
// The clock inside a static program; the counterpart of preload/clock.h without a C library.
#ifndef SITL_STATIC_RUNTIME_H
#define SITL_STATIC_RUNTIME_H

#include "../preload/line.h"
#include "machine.h"

#include <time.h>

HIDDEN int64_t runtime_now(void);                                  // simulated time [ns]
HIDDEN int64_t runtime_wall_until(int64_t deadline_ns); // wall time [ns] to wait before the next look
HIDDEN int64_t runtime_wall_length(int64_t sim_ns);                // wall time [ns] that simulated time lasts
HIDDEN int64_t runtime_after(int64_t ns);                          // simulated deadline this long from now
HIDDEN int64_t runtime_at(clockid_t id, const struct timespec *t); // simulated deadline at a date of clock `id`
HIDDEN int runtime_is_warped(clockid_t id);
HIDDEN int runtime_gettime(clockid_t id, struct timespec *out);

static inline int64_t from_spec(const struct timespec *t) {
  return t->tv_sec >= 9000000000ll ? WARP_FOREVER : (int64_t)t->tv_sec * WARP_SECOND + t->tv_nsec;
}

static inline struct timespec to_spec(int64_t ns) {
  if (ns < 0) ns = 0;
  return (struct timespec){ns / WARP_SECOND, ns % WARP_SECOND};
}

#endif
