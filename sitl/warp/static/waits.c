// SPDX-License-Identifier: BSD-3-Clause
// The system calls that wait or ask the time, on the simulated clock: waits are cut into pieces of wall time.
#define _GNU_SOURCE
#include "runtime.h"

#include <errno.h>
#include <linux/futex.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/timerfd.h>

#define SIGSET_BYTES 8

// Repeats `call`, which waits for `t`, while it returns `nothing`, until the simulated deadline.
#define REPEAT(deadline, nothing, call, again)                    \
  for (;;) {                                 \
    int64_t wall = runtime_wall_until(deadline);           \
    struct timespec t = to_spec(wall);                            \
    long result = call;                                           \
    if (result != (nothing) || wall <= 0) return result;          \
    again;                                                        \
  }

static long sleep_until(int64_t deadline) {
  for (;;) {
    int64_t wall = runtime_wall_until(deadline);
    if (wall <= 0) return 0;
    struct timespec t = to_spec(wall);
    long error = CALL(SYS_clock_nanosleep, CLOCK_MONOTONIC, 0, &t, 0);
    if (error) return error;
  }
}

static long nap(clockid_t id, int absolute, const struct timespec *t, struct timespec *left) {
  int64_t deadline = absolute ? runtime_at(id, t) : runtime_after(from_spec(t));
  long error = sleep_until(deadline);
  if (error && left && !absolute) *left = to_spec(deadline - runtime_now());
  return error;
}

static long futex(const long a[6]) {
  long op = a[1] & ~FUTEX_CLOCK_REALTIME;
  int whole = (op & FUTEX_CMD_MASK) == FUTEX_WAIT; // relative time-out, any waker
  clockid_t id = a[1] & FUTEX_CLOCK_REALTIME ? CLOCK_REALTIME : CLOCK_MONOTONIC;
  const struct timespec *at = (const struct timespec *)a[3];
  int64_t deadline = whole ? runtime_after(from_spec(at)) : runtime_at(id, at);
  op = (op & ~FUTEX_CMD_MASK) | FUTEX_WAIT_BITSET;
  for (;;) {
    int64_t wall = runtime_wall_until(deadline);
    struct timespec now, t;
    CALL(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
    t = to_spec(from_spec(&now) + wall);
    // A wake-up between two pieces is not lost: its sender has changed the word first, so the next piece ends at once.
    long result = CALL(SYS_futex, a[0], op, a[2], &t, 0, whole ? (long)FUTEX_BITSET_MATCH_ANY : a[5]);
    if (result != -ETIMEDOUT || wall <= 0) return result;
  }
}

static long epoll(const long a[6], int64_t deadline, long mask) {
  REPEAT(deadline, 0, CALL(SYS_epoll_pwait2, a[0], a[1], a[2], &t, mask, SIGSET_BYTES), )
}

static long poll_(const long a[6], int64_t deadline, long mask) {
  REPEAT(deadline, 0, CALL(SYS_ppoll, a[0], a[1], &t, mask, SIGSET_BYTES), )
}

static long select_(const long a[6], int64_t deadline, long mask) {
  fd_set asked[3];
  for (int i = 0; i < 3; i++)
    if (a[i + 1]) asked[i] = *(fd_set *)a[i + 1];
  REPEAT(deadline, 0, CALL(SYS_pselect6, a[0], a[1], a[2], a[3], &t, mask),
         for (int i = 0; i < 3; i++) if (a[i + 1]) *(fd_set *)a[i + 1] = asked[i])
}

static struct timespec shorten(struct timespec t) {
  int64_t ns = from_spec(&t);
  return ns ? to_spec(runtime_wall_length(ns)) : t;
}

static long timer(const long a[6]) {
  const struct itimerspec *sim = (const struct itimerspec *)a[2];
  struct itimerspec wall = {shorten(sim->it_interval), shorten(sim->it_value)};
  if (a[1] & TFD_TIMER_ABSTIME && from_spec(&sim->it_value)) {
    clockid_t id = sim->it_value.tv_sec > 1000000000 ? CLOCK_REALTIME : CLOCK_MONOTONIC;
    int64_t left = runtime_at(id, &sim->it_value) - runtime_now();
    wall.it_value = to_spec(left > 0 ? runtime_wall_length(left) : 1);
  }
  return CALL(SYS_timerfd_settime, a[0], 0, &wall, a[3]);
}

static long set_option(const long a[6]) {
  const struct timeval *sim = (const struct timeval *)a[3];
  int64_t ns = sim->tv_sec * WARP_SECOND + sim->tv_usec * 1000ll;
  int64_t wall = ns ? runtime_wall_length(ns) : 0;
  struct timeval t = {wall / WARP_SECOND, (wall % WARP_SECOND + 999) / 1000};
  return CALL(SYS_setsockopt, a[0], a[1], a[2], &t, sizeof t);
}

// See preload/sockets.c: TCP's delays are wall time.
static long socket_(const long a[6]) {
  long fd = CALL(SYS_socket, a[0], a[1], a[2]);
  int on = 1;
  if (fd >= 0 && (a[1] & 0xf) == SOCK_STREAM && (a[0] == AF_INET || a[0] == AF_INET6))
    CALL(SYS_setsockopt, fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return fd;
}

static int64_t after_ms(long ms) { return runtime_after((int)ms * 1000000ll); }
static int64_t after_spec(long t) { return runtime_after(from_spec((const struct timespec *)t)); }

long warp_handle(long number, const long a[6]) {
  switch (number) {
  case SYS_clock_gettime:
    if (runtime_is_warped((clockid_t)a[0])) return runtime_gettime((clockid_t)a[0], (struct timespec *)a[1]);
    break;
  case SYS_gettimeofday: {
    struct timespec t;
    runtime_gettime(CLOCK_REALTIME, &t);
    if (a[0]) *(struct timeval *)a[0] = (struct timeval){t.tv_sec, t.tv_nsec / 1000};
    return 0;
  }
  case SYS_nanosleep: return nap(CLOCK_MONOTONIC, 0, (const struct timespec *)a[0], (struct timespec *)a[1]);
  case SYS_clock_nanosleep:
    if (runtime_is_warped((clockid_t)a[0]))
      return nap((clockid_t)a[0], (int)a[1] & TIMER_ABSTIME, (const struct timespec *)a[2], (struct timespec *)a[3]);
    break;
  case SYS_futex: return futex(a);
  case SYS_epoll_pwait: return epoll(a, after_ms(a[3]), a[4]);
  case SYS_epoll_pwait2: return epoll(a, after_spec(a[3]), a[4]);
  case SYS_ppoll: return poll_(a, after_spec(a[2]), a[3]);
  case SYS_pselect6:
    if (a[0] <= FD_SETSIZE) return select_(a, after_spec(a[4]), a[5]);
    break;
  case SYS_timerfd_settime: return timer(a);
  case SYS_setsockopt: return set_option(a);
  case SYS_socket: return socket_(a);
#ifdef SYS_epoll_wait
  case SYS_epoll_wait: return epoll(a, after_ms(a[3]), 0);
  case SYS_poll: return poll_(a, after_ms(a[2]), 0);
  case SYS_select:
    if (a[0] <= FD_SETSIZE) {
      const struct timeval *t = (const struct timeval *)a[4];
      return select_(a, runtime_after(t->tv_sec * WARP_SECOND + t->tv_usec * 1000ll), 0);
    }
    break;
  case SYS_time: {
    struct timespec t;
    runtime_gettime(CLOCK_REALTIME, &t);
    if (a[0]) *(time_t *)a[0] = t.tv_sec;
    return t.tv_sec;
  }
#endif
  }
  return CALL(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}
