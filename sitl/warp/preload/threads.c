// SPDX-License-Identifier: BSD-3-Clause
// Timed waits of threads for each other: condition variables, semaphores, locks, joins, bare futexes.
#define _GNU_SOURCE
#include "clock.h"

#include <errno.h>
#include <linux/futex.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdarg.h>
#include <sys/syscall.h>
#include <unistd.h>

// A deadline on the machine's own clock `id`, `wall` ns from now.
static struct timespec real_deadline(clockid_t id, int64_t wall) { return warp_to_spec(warp_real(id) + wall); }

// Waits that keep their state (a semaphore's count, a lock's owner) may be cut into pieces and repeated.
#define REPEAT_UNTIL(deadline, id, call)                                  \
  for (;;) {                                         \
    int64_t wall = warp_wall_until(deadline);                      \
    struct timespec t = real_deadline(id, wall);                          \
    int error = call;                                                     \
    if (error != ETIMEDOUT || wall <= 0) return error;                    \
  }

// A condition variable may not: a signal that falls between two pieces would be lost. So one piece, and if the simulated
// deadline is not there yet the wait ends "spuriously", which POSIX allows and every caller must expect.
#define ONCE_UNTIL(deadline, id, call)                                    \
  int64_t wall = warp_wall_until(deadline);                            \
  struct timespec t = real_deadline(id, wall);                            \
  int error = call;                                                       \
  if (error != ETIMEDOUT || wall <= 0) return error;                      \
  return warp_now() < (deadline) ? 0 : ETIMEDOUT

int pthread_cond_timedwait(pthread_cond_t *restrict c, pthread_mutex_t *restrict m,
                           const struct timespec *restrict at) {
  WARP_REAL(int, pthread_cond_timedwait, pthread_cond_t *, pthread_mutex_t *, const struct timespec *);
  if (!warp_active()) return real_pthread_cond_timedwait(c, m, at);
  clockid_t id = warp_clock_of(at); // the clock is in the variable's hidden attributes; its dates tell it as well
  int64_t deadline = warp_at(id, at);
  ONCE_UNTIL(deadline, id, real_pthread_cond_timedwait(c, m, &t));
}

int pthread_cond_clockwait(pthread_cond_t *restrict c, pthread_mutex_t *restrict m, clockid_t id,
                           const struct timespec *restrict at) {
  WARP_REAL(int, pthread_cond_clockwait, pthread_cond_t *, pthread_mutex_t *, clockid_t, const struct timespec *);
  if (!warp_active()) return real_pthread_cond_clockwait(c, m, id, at);
  int64_t deadline = warp_at(id, at);
  ONCE_UNTIL(deadline, id, real_pthread_cond_clockwait(c, m, id, &t));
}

int pthread_mutex_timedlock(pthread_mutex_t *restrict m, const struct timespec *restrict at) {
  WARP_REAL(int, pthread_mutex_timedlock, pthread_mutex_t *, const struct timespec *);
  if (!warp_active()) return real_pthread_mutex_timedlock(m, at);
  int64_t deadline = warp_at(CLOCK_REALTIME, at);
  REPEAT_UNTIL(deadline, CLOCK_REALTIME, real_pthread_mutex_timedlock(m, &t));
}

int pthread_mutex_clocklock(pthread_mutex_t *restrict m, clockid_t id, const struct timespec *restrict at) {
  WARP_REAL(int, pthread_mutex_clocklock, pthread_mutex_t *, clockid_t, const struct timespec *);
  if (!warp_active()) return real_pthread_mutex_clocklock(m, id, at);
  int64_t deadline = warp_at(id, at);
  REPEAT_UNTIL(deadline, id, real_pthread_mutex_clocklock(m, id, &t));
}

int pthread_rwlock_timedrdlock(pthread_rwlock_t *restrict l, const struct timespec *restrict at) {
  WARP_REAL(int, pthread_rwlock_timedrdlock, pthread_rwlock_t *, const struct timespec *);
  if (!warp_active()) return real_pthread_rwlock_timedrdlock(l, at);
  int64_t deadline = warp_at(CLOCK_REALTIME, at);
  REPEAT_UNTIL(deadline, CLOCK_REALTIME, real_pthread_rwlock_timedrdlock(l, &t));
}

int pthread_rwlock_timedwrlock(pthread_rwlock_t *restrict l, const struct timespec *restrict at) {
  WARP_REAL(int, pthread_rwlock_timedwrlock, pthread_rwlock_t *, const struct timespec *);
  if (!warp_active()) return real_pthread_rwlock_timedwrlock(l, at);
  int64_t deadline = warp_at(CLOCK_REALTIME, at);
  REPEAT_UNTIL(deadline, CLOCK_REALTIME, real_pthread_rwlock_timedwrlock(l, &t));
}

int pthread_timedjoin_np(pthread_t thread, void **result, const struct timespec *at) {
  WARP_REAL(int, pthread_timedjoin_np, pthread_t, void **, const struct timespec *);
  if (!warp_active() || !at) return real_pthread_timedjoin_np(thread, result, at);
  int64_t deadline = warp_at(CLOCK_REALTIME, at);
  REPEAT_UNTIL(deadline, CLOCK_REALTIME, real_pthread_timedjoin_np(thread, result, &t));
}

// Semaphores report by errno. EINTR goes to the caller, as it should.
#define REPEAT_SEMAPHORE(deadline, id, call)                              \
  for (;;) {                                         \
    int64_t wall = warp_wall_until(deadline);                      \
    struct timespec t = real_deadline(id, wall);                          \
    int result = call;                                                    \
    if (result == 0 || errno != ETIMEDOUT || wall <= 0) return result;    \
  }

int sem_timedwait(sem_t *restrict s, const struct timespec *restrict at) {
  WARP_REAL(int, sem_timedwait, sem_t *, const struct timespec *);
  if (!warp_active()) return real_sem_timedwait(s, at);
  int64_t deadline = warp_at(CLOCK_REALTIME, at);
  REPEAT_SEMAPHORE(deadline, CLOCK_REALTIME, real_sem_timedwait(s, &t));
}

int sem_clockwait(sem_t *restrict s, clockid_t id, const struct timespec *restrict at) {
  WARP_REAL(int, sem_clockwait, sem_t *, clockid_t, const struct timespec *);
  if (!warp_active()) return real_sem_clockwait(s, id, at);
  int64_t deadline = warp_at(id, at);
  REPEAT_SEMAPHORE(deadline, id, real_sem_clockwait(s, id, &t));
}

static long futex_until(long real(long, ...), long word, long op, long expected, int64_t deadline, long f, long bits) {
  long command = op & ~(FUTEX_CLOCK_REALTIME | FUTEX_CMD_MASK);
  for (;;) {
    int64_t wall = warp_wall_until(deadline);
    struct timespec t = real_deadline(CLOCK_MONOTONIC, wall);
    // A wake-up between two pieces is not lost: its sender has changed the word first.
    long result = real(SYS_futex, word, command | FUTEX_WAIT_BITSET, expected, &t, f, bits);
    if (result == 0 || errno != ETIMEDOUT || wall <= 0) return result;
  }
}

// Native libraries wait on futexes, and some ask the time, without the C library's help.
long syscall(long number, ...) {
  WARP_REAL(long, syscall, long, ...);
  va_list v;
  va_start(v, number);
  long a = va_arg(v, long), b = va_arg(v, long), c = va_arg(v, long);
  long d = va_arg(v, long), e = va_arg(v, long), f = va_arg(v, long);
  va_end(v);
  if (warp_active()) {
    if (number == SYS_futex && d) {
      const struct timespec *at = (const struct timespec *)d;
      int command = (int)b & FUTEX_CMD_MASK;
      if (command == FUTEX_WAIT)
        return futex_until(real_syscall, a, b, c, warp_after(warp_from_spec(at)), 0, FUTEX_BITSET_MATCH_ANY);
      if (command == FUTEX_WAIT_BITSET) {
        clockid_t id = b & FUTEX_CLOCK_REALTIME ? CLOCK_REALTIME : CLOCK_MONOTONIC;
        return futex_until(real_syscall, a, b, c, warp_at(id, at), e, f);
      }
    }
    if (number == SYS_clock_gettime) return clock_gettime((clockid_t)a, (struct timespec *)b);
#ifdef SYS_nanosleep
    if (number == SYS_nanosleep) return nanosleep((const struct timespec *)a, (struct timespec *)b);
#endif
  }
  return real_syscall(number, a, b, c, d, e, f);
}
