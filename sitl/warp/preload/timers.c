// SPDX-License-Identifier: BSD-3-Clause
// Timers the kernel keeps (those that send signals are in signals.c): set once in wall time for the rate of that moment. Where the clock slows down later they go
// off early: event loops (asio, which MAVSDK is built on) then find nothing due and set the timer again.
#define _GNU_SOURCE
#include "clock.h"

#include <signal.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <unistd.h>

static struct timespec shorten(struct timespec t) {
  int64_t ns = warp_from_spec(&t);
  return ns ? warp_to_spec(warp_wall_length(ns)) : t;
}

static struct timespec lengthen(struct timespec t) { return warp_to_spec(warp_sim_length(warp_from_spec(&t))); }

static struct itimerspec to_wall(const struct itimerspec *sim, int absolute) {
  struct itimerspec wall = {.it_interval = shorten(sim->it_interval), .it_value = sim->it_value};
  if (absolute && (sim->it_value.tv_sec || sim->it_value.tv_nsec)) {
    int64_t left = warp_at(warp_clock_of(&sim->it_value), &sim->it_value) - warp_now();
    wall.it_value = warp_to_spec(left > 0 ? warp_wall_length(left) : 1);
  } else {
    wall.it_value = shorten(sim->it_value);
  }
  return wall;
}

int timerfd_settime(int fd, int flags, const struct itimerspec *next, struct itimerspec *before) {
  WARP_REAL(int, timerfd_settime, int, int, const struct itimerspec *, struct itimerspec *);
  if (!warp_active()) return real_timerfd_settime(fd, flags, next, before);
  struct itimerspec wall = to_wall(next, flags & TFD_TIMER_ABSTIME);
  int result = real_timerfd_settime(fd, 0, &wall, before);
  if (!result && before)
    *before = (struct itimerspec){lengthen(before->it_interval), lengthen(before->it_value)};
  return result;
}

int timerfd_gettime(int fd, struct itimerspec *now) {
  WARP_REAL(int, timerfd_gettime, int, struct itimerspec *);
  int result = real_timerfd_gettime(fd, now);
  if (!result && warp_active()) *now = (struct itimerspec){lengthen(now->it_interval), lengthen(now->it_value)};
  return result;
}

int timer_settime(timer_t id, int flags, const struct itimerspec *next, struct itimerspec *before) {
  WARP_REAL(int, timer_settime, timer_t, int, const struct itimerspec *, struct itimerspec *);
  if (!warp_active()) return real_timer_settime(id, flags, next, before);
  int64_t value = warp_from_spec(&next->it_value), deadline = value ? warp_after(value) : 0;
  if (value && flags & TIMER_ABSTIME) deadline = warp_at(warp_clock_of(&next->it_value), &next->it_value);
  if (value && deadline < 1) deadline = 1;
  int done;
  if (warp_set_signal_timer(id, deadline, warp_from_spec(&next->it_interval), before, &done)) return done;
  struct itimerspec wall = to_wall(next, flags & TIMER_ABSTIME);
  int result = real_timer_settime(id, 0, &wall, before);
  if (!result && before)
    *before = (struct itimerspec){lengthen(before->it_interval), lengthen(before->it_value)};
  return result;
}

struct timeval warp_wall_timeval(struct timeval t) {
  int64_t ns = t.tv_sec * WARP_SECOND + t.tv_usec * 1000ll;
  if (!ns) return t;
  int64_t wall = warp_wall_length(ns);
  return (struct timeval){wall / WARP_SECOND, (wall % WARP_SECOND + 999) / 1000};
}
