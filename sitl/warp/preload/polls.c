// SPDX-License-Identifier: BSD-3-Clause
// Waits for files and sockets with a time-out: each is cut into waits in wall time until the simulated deadline.
#define _GNU_SOURCE
#include "clock.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <unistd.h>

typedef int (*ppoll_fn)(struct pollfd *, nfds_t, const struct timespec *, const sigset_t *);

static int poll_until(struct pollfd *fds, nfds_t n, int64_t deadline, const sigset_t *mask) {
  WARP_REAL(int, ppoll, struct pollfd *, nfds_t, const struct timespec *, const sigset_t *);
  for (;;) {
    int64_t wall = warp_wall_until(deadline);
    struct timespec t = warp_to_spec(wall);
    int ready = real_ppoll(fds, n, &t, mask);
    if (ready != 0 || wall <= 0) return ready;
  }
}

int ppoll(struct pollfd *fds, nfds_t n, const struct timespec *timeout, const sigset_t *mask) {
  WARP_REAL(int, ppoll, struct pollfd *, nfds_t, const struct timespec *, const sigset_t *);
  if (!warp_active() || !timeout || (timeout->tv_sec == 0 && timeout->tv_nsec == 0))
    return real_ppoll(fds, n, timeout, mask);
  return poll_until(fds, n, warp_after(warp_from_spec(timeout)), mask);
}

int poll(struct pollfd *fds, nfds_t n, int timeout_ms) {
  WARP_REAL(int, poll, struct pollfd *, nfds_t, int);
  if (!warp_active() || timeout_ms <= 0) return real_poll(fds, n, timeout_ms);
  return poll_until(fds, n, warp_after(timeout_ms * 1000000ll), NULL);
}

// _FORTIFY_SOURCE compiles poll and ppoll to these; the extra size was checked against when the caller was built.
int __poll_chk(struct pollfd *fds, nfds_t n, int timeout_ms, size_t size) {
  (void)size;
  return poll(fds, n, timeout_ms);
}

int __ppoll_chk(struct pollfd *fds, nfds_t n, const struct timespec *t, const sigset_t *mask, size_t size) {
  (void)size;
  return ppoll(fds, n, t, mask);
}

#define SET_BYTES(n) ((((size_t)(n) + 63) / 64) * 8)
#define SET_BYTES_MAX 8192 // 65536 descriptors; a wait on more is passed on as it is

static int select_until(int n, fd_set *sets[3], int64_t deadline, const sigset_t *mask) {
  WARP_REAL(int, pselect, int, fd_set *, fd_set *, fd_set *, const struct timespec *, const sigset_t *);
  size_t bytes = SET_BYTES(n);
  char asked[3][bytes ? bytes : 1];
  for (int i = 0; i < 3; i++)
    if (sets[i]) memcpy(asked[i], sets[i], bytes);
  for (;;) {
    int64_t wall = warp_wall_until(deadline);
    struct timespec t = warp_to_spec(wall);
    int ready = real_pselect(n, sets[0], sets[1], sets[2], &t, mask);
    if (ready != 0 || wall <= 0) return ready;
    for (int i = 0; i < 3; i++) // a wait that ran out has cleared the sets
      if (sets[i]) memcpy(sets[i], asked[i], bytes);
  }
}

int select(int n, fd_set *restrict r, fd_set *restrict w, fd_set *restrict x, struct timeval *restrict timeout) {
  WARP_REAL(int, select, int, fd_set *, fd_set *, fd_set *, struct timeval *);
  if (!warp_active() || !timeout || (timeout->tv_sec == 0 && timeout->tv_usec == 0) || n < 0 ||
      SET_BYTES(n) > SET_BYTES_MAX)
    return real_select(n, r, w, x, timeout);
  int64_t deadline = warp_after(timeout->tv_sec * WARP_SECOND + timeout->tv_usec * 1000ll);
  int ready = select_until(n, (fd_set *[3]){r, w, x}, deadline, NULL);
  int saved = errno;
  struct timespec left = warp_to_spec(deadline - warp_now()); // Linux tells the time not slept
  timeout->tv_sec = left.tv_sec;
  timeout->tv_usec = left.tv_nsec / 1000;
  errno = saved;
  return ready;
}

int pselect(int n, fd_set *restrict r, fd_set *restrict w, fd_set *restrict x, const struct timespec *restrict timeout,
            const sigset_t *restrict mask) {
  WARP_REAL(int, pselect, int, fd_set *, fd_set *, fd_set *, const struct timespec *, const sigset_t *);
  if (!warp_active() || !timeout || (timeout->tv_sec == 0 && timeout->tv_nsec == 0) || n < 0 ||
      SET_BYTES(n) > SET_BYTES_MAX)
    return real_pselect(n, r, w, x, timeout, mask);
  return select_until(n, (fd_set *[3]){r, w, x}, warp_after(warp_from_spec(timeout)), mask);
}

// epoll_wait counts in milliseconds, too coarse at 50x; epoll_pwait2 (Linux 5.11) in nanoseconds. Older kernels wait
// on the epoll descriptor itself, then collect.
static int epoll_slice(int ep, struct epoll_event *ev, int n, int64_t wall, const sigset_t *mask) {
#ifdef SYS_epoll_pwait2
  WARP_REAL(long, syscall, long, ...);
  static int missing;
  if (!missing) {
    struct timespec t = warp_to_spec(wall);
    long ready = real_syscall(SYS_epoll_pwait2, ep, ev, n, &t, mask, (size_t)(_NSIG / 8));
    if (ready >= 0 || errno != ENOSYS) return (int)ready;
    missing = 1;
  }
#endif
  WARP_REAL(int, ppoll, struct pollfd *, nfds_t, const struct timespec *, const sigset_t *);
  WARP_REAL(int, epoll_wait, int, struct epoll_event *, int, int);
  struct timespec t2 = warp_to_spec(wall);
  struct pollfd p = {.fd = ep, .events = POLLIN};
  int any = real_ppoll(&p, 1, &t2, mask);
  return any < 0 ? any : real_epoll_wait(ep, ev, n, 0);
}

static int epoll_until(int ep, struct epoll_event *ev, int n, int64_t deadline, const sigset_t *mask) {
  for (;;) {
    int64_t wall = warp_wall_until(deadline);
    int ready = epoll_slice(ep, ev, n, wall, mask);
    if (ready != 0 || wall <= 0) return ready;
  }
}

int epoll_wait(int ep, struct epoll_event *ev, int n, int timeout_ms) {
  WARP_REAL(int, epoll_wait, int, struct epoll_event *, int, int);
  if (!warp_active() || timeout_ms <= 0) return real_epoll_wait(ep, ev, n, timeout_ms);
  return epoll_until(ep, ev, n, warp_after(timeout_ms * 1000000ll), NULL);
}

int epoll_pwait(int ep, struct epoll_event *ev, int n, int timeout_ms, const sigset_t *mask) {
  WARP_REAL(int, epoll_pwait, int, struct epoll_event *, int, int, const sigset_t *);
  if (!warp_active() || timeout_ms <= 0) return real_epoll_pwait(ep, ev, n, timeout_ms, mask);
  return epoll_until(ep, ev, n, warp_after(timeout_ms * 1000000ll), mask);
}

int epoll_pwait2(int ep, struct epoll_event *ev, int n, const struct timespec *timeout, const sigset_t *mask) {
  WARP_REAL(int, epoll_pwait2, int, struct epoll_event *, int, const struct timespec *, const sigset_t *);
  if (!warp_active() || !timeout || (timeout->tv_sec == 0 && timeout->tv_nsec == 0)) {
    if (real_epoll_pwait2) return real_epoll_pwait2(ep, ev, n, timeout, mask);
    return epoll_pwait(ep, ev, n, timeout ? 0 : -1, mask);
  }
  return epoll_until(ep, ev, n, warp_after(warp_from_spec(timeout)), mask);
}
