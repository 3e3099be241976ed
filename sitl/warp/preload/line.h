// SPDX-License-Identifier: BSD-3-Clause
// The clock page and the arithmetic on it, free of any C library: shared by the preload library and by the runtime for
// static programs. Layout and meaning are documented in sitl/warp/page.py; keep both equal.
#ifndef SITL_WARP_LINE_H
#define SITL_WARP_LINE_H

#include <stdint.h>

#define WARP_MAGIC 0x3150524157495453ull
#define WARP_PAGE_BYTES 4096
#define WARP_PID_SLOTS 256
#define WARP_SECOND 1000000000ll
#define WARP_FOREVER INT64_MAX

#define WARP_LONGEST_LOOK 200000000ll   // [ns wall] so that a change of rate is noticed by a waiting thread
#define WARP_STALLED_LOOK 50000ll       // [ns wall] first look at a stopped clock; a quarter of the stop up to...
#define WARP_STALLED_LOOK_MAX 2000000ll // [ns wall]
#define WARP_ORPHANED 2000000000ll      // [ns wall] silence after which the simulator is checked for being alive

enum { WARP_WAITING = 0, WARP_RUNNING = 1, WARP_RELEASED = 2 };

// One straight piece of the warped clock. All nanoseconds; `rate` is warped ns per wall ns.
struct warp_line {
  uint64_t count;     // publications so far
  int64_t wall_ns;    // CLOCK_MONOTONIC of the machine where the piece starts
  int64_t sim_ns;     // simulated time there
  double rate;        //
  int64_t ceiling_ns; // the clock stops here until the next publication
  uint64_t state;     // WARP_WAITING, WARP_RUNNING or WARP_RELEASED
  uint64_t check;     // exclusive-or of the six words above and WARP_MAGIC: a torn read does not match
};

struct warp_page {
  uint64_t magic;
  uint64_t bytes;
  int64_t epoch_ns;  // CLOCK_REALTIME at simulated time zero
  int64_t uptime_ns; // CLOCK_MONOTONIC at simulated time zero
  int64_t writer;    // process id of the simulator
  int64_t reserved[3];
  struct warp_line line; // offset 64
  int64_t reserved2[9];
  volatile int32_t pids[WARP_PID_SLOTS]; // offset 192: processes on this clock; 0 = free
};

// What a process knows of its clock. `now` may be asked by many threads at once.
struct warp_clock {
  struct warp_page *page;
  int64_t latest;      // greatest simulated time seen [ns]: the clock never goes back within a process
  int64_t orphaned_at; // wall time [ns] at which the simulator was found dead, else 0; then the clock runs at 1x
  int64_t asked_at;    // wall time [ns] of the last such check
};

static inline struct warp_line warp_read(const struct warp_page *page) {
  union {
    struct warp_line line;
    uint64_t words[7];
  } u;
  for (;;) {
    uint64_t sum = WARP_MAGIC;
    const volatile uint64_t *from = (const volatile uint64_t *)&page->line;
    for (int i = 0; i < 7; i++) u.words[i] = from[i];
    for (int i = 0; i < 6; i++) sum ^= u.words[i];
    if (sum == u.words[6]) return u.line;
  }
}

// Simulated time [ns] of the piece at wall time `wall` [ns].
static inline int64_t warp_line_at(const struct warp_line *l, int64_t wall) {
  if (l->state == WARP_WAITING) return l->sim_ns;
  double ahead = (double)(wall - l->wall_ns) * l->rate;
  int64_t room = l->ceiling_ns - l->sim_ns;
  if (room < 0) room = 0;
  if (ahead < 0) ahead = 0;
  return l->sim_ns + (ahead < (double)room ? (int64_t)ahead : room);
}

// 1 when it is time to ask whether the simulator still lives: it has been silent for long.
static inline int warp_should_ask(struct warp_clock *c, const struct warp_line *l, int64_t wall) {
  if (c->orphaned_at || l->state == WARP_RELEASED) return 0;
  if (wall - l->wall_ns < WARP_ORPHANED || wall - c->asked_at < WARP_ORPHANED) return 0;
  c->asked_at = wall;
  return 1;
}

static inline int64_t warp_advance(struct warp_clock *c, const struct warp_line *l, int64_t wall) {
  int64_t now = warp_line_at(l, wall);
  if (c->orphaned_at) now += wall - c->orphaned_at;
  int64_t before = __atomic_load_n(&c->latest, __ATOMIC_RELAXED);
  while (now > before)
    if (__atomic_compare_exchange_n(&c->latest, &before, now, 1, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) return now;
  return before;
}

static inline double warp_rate(const struct warp_clock *c, const struct warp_line *l) {
  if (c->orphaned_at) return 1.0;
  return l->state == WARP_WAITING ? 0.0 : l->rate;
}

// Wall time [ns] to wait before the next look at the clock, now at `now`, when it should reach `deadline` (simulated);
// 0 when it has. `wall` is the wall time now. A clock that stopped long ago is looked at less often than one that just did.
static inline int64_t warp_look(const struct warp_clock *c, const struct warp_line *l, int64_t wall, int64_t now,
                                int64_t deadline) {
  if (deadline <= now) return 0;
  double rate = warp_rate(c, l);
  double length = rate > 0.0 ? (double)(deadline - now) / rate + 1.0 : 0.0;
  if (rate <= 0.0 || (now >= l->ceiling_ns && !c->orphaned_at)) {
    double look = (double)(wall - l->wall_ns) / 4;
    if (look < (double)WARP_STALLED_LOOK) look = (double)WARP_STALLED_LOOK;
    if (look > (double)WARP_STALLED_LOOK_MAX) look = (double)WARP_STALLED_LOOK_MAX;
    if (length < look) length = look;
  }
  return length < (double)WARP_LONGEST_LOOK ? (int64_t)length : WARP_LONGEST_LOOK;
}

// Wall time [ns] that `sim` ns of simulated time last from now on, if the rate stays; at least 1.
static inline int64_t warp_length(const struct warp_clock *c, const struct warp_line *l, int64_t now, int64_t sim) {
  double rate = warp_rate(c, l);
  if (rate <= 0.0) return WARP_STALLED_LOOK_MAX;
  double wall = (double)sim / rate, least = now >= l->ceiling_ns && !c->orphaned_at ? WARP_STALLED_LOOK : 1;
  if (wall > 9e18) return WARP_FOREVER;
  return (int64_t)(wall > least ? wall : least);
}

static inline void warp_register(struct warp_page *page, int32_t self) {
  for (int i = 0; i < WARP_PID_SLOTS; i++) {
    int32_t empty = 0;
    if (page->pids[i] == self) return;
    if (__atomic_compare_exchange_n(&page->pids[i], &empty, self, 0, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST)) return;
  }
}

#endif
