// SPDX-License-Identifier: BSD-3-Clause
// Plain sleeps: the thread waits for nothing but time.
#define _GNU_SOURCE
#include "clock.h"

#include <errno.h>
#include <signal.h>
#include <unistd.h>

// Sleeps until simulated time `deadline` [ns]; 0, or EINTR when a signal handler ran.
static int sleep_until(int64_t deadline) {
  WARP_REAL(int, clock_nanosleep, clockid_t, int, const struct timespec *, struct timespec *);
  for (;;) {
    int64_t wall = warp_wall_until(deadline);
    if (wall <= 0) return 0;
    struct timespec t = warp_to_spec(wall);
    int error = real_clock_nanosleep(CLOCK_MONOTONIC, 0, &t, NULL);
    if (error) return error;
  }
}

int clock_nanosleep(clockid_t id, int flags, const struct timespec *t, struct timespec *left) {
  WARP_REAL(int, clock_nanosleep, clockid_t, int, const struct timespec *, struct timespec *);
  if (!warp_active() || !warp_is_warped(id)) return real_clock_nanosleep(id, flags, t, left);
  if (t->tv_nsec < 0 || t->tv_nsec >= WARP_SECOND || t->tv_sec < 0) return EINVAL;
  int absolute = flags & TIMER_ABSTIME;
  int64_t deadline = absolute ? warp_at(id, t) : warp_after(warp_from_spec(t));
  int error = sleep_until(deadline);
  if (error && left && !absolute) *left = warp_to_spec(deadline - warp_now());
  return error;
}

int nanosleep(const struct timespec *t, struct timespec *left) {
  WARP_REAL(int, nanosleep, const struct timespec *, struct timespec *);
  if (!warp_active()) return real_nanosleep(t, left);
  int error = clock_nanosleep(CLOCK_MONOTONIC, 0, t, left);
  if (!error) return 0;
  errno = error;
  return -1;
}

int usleep(useconds_t us) {
  struct timespec t = {us / 1000000u, (long)(us % 1000000u) * 1000};
  return nanosleep(&t, NULL);
}

unsigned int sleep(unsigned int seconds) {
  struct timespec t = {seconds, 0}, left = {0, 0};
  if (nanosleep(&t, &left) == 0) return 0;
  return (unsigned int)left.tv_sec + (left.tv_nsec >= WARP_SECOND / 2);
}

// Waiting for a signal: what has come meanwhile stays pending, so the wait may be cut into pieces.
int sigtimedwait(const sigset_t *restrict set, siginfo_t *restrict info, const struct timespec *restrict timeout) {
  WARP_REAL(int, sigtimedwait, const sigset_t *, siginfo_t *, const struct timespec *);
  if (!warp_active() || !timeout) return real_sigtimedwait(set, info, timeout);
  int64_t deadline = warp_after(warp_from_spec(timeout));
  for (;;) {
    int64_t wall = warp_wall_until(deadline);
    struct timespec t = warp_to_spec(wall);
    int number = real_sigtimedwait(set, info, &t);
    if (number >= 0 || errno != EAGAIN || wall <= 0) return number;
  }
}
