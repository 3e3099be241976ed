// SPDX-License-Identifier: BSD-3-Clause
// Timers that send a signal: alarm, setitimer(ITIMER_REAL), and timer_create with SIGEV_SIGNAL. A thread of this library
// waits on the simulated clock and sends the signal, never early. As the kernel's they are not inherited by fork; unlike
// the kernel's they end at exec.
#define _GNU_SOURCE
#include "clock.h"

#include <errno.h>
#include <limits.h>
#include <linux/futex.h>
#include <pthread.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#define TIMERS 64 // the first is alarm's and setitimer's

struct signal_timer {
  int used;
  timer_t id; // the kernel's, which is never set
  int number;
  union sigval value;
  int64_t deadline, interval; // simulated [ns]; deadline 0: not set
};

static struct signal_timer timers[TIMERS] = {{.used = 1, .number = SIGALRM}};
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static volatile int32_t changes; // counts; the thread waits on it
static int thread_runs;

// A handler that sets a timer must not interrupt one that holds the lock.
static void take(sigset_t *before) {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, before);
  pthread_mutex_lock(&lock);
}

static void give(const sigset_t *before) {
  int saved = errno;
  pthread_mutex_unlock(&lock);
  pthread_sigmask(SIG_SETMASK, before, NULL);
  errno = saved;
}

// Sends what is due and finds the next deadline.
static int64_t fire(int64_t now) {
  int64_t next = WARP_FOREVER;
  for (int i = 0; i < TIMERS; i++) {
    struct signal_timer *t = &timers[i];
    if (!t->used || !t->deadline) continue;
    if (t->deadline <= now) {
      if (t->interval) // what was missed while nobody could run is one signal, as the kernel's
        t->deadline += t->interval * (1 + (now - t->deadline) / t->interval);
      else
        t->deadline = 0;
      if (i)
        sigqueue(getpid(), t->number, t->value);
      else
        kill(getpid(), t->number);
    }
    if (t->deadline && t->deadline < next) next = t->deadline;
  }
  return next;
}

static void *send_signals(void *nothing) {
  for (;;) {
    int32_t seen = __atomic_load_n(&changes, __ATOMIC_SEQ_CST);
    pthread_mutex_lock(&lock);
    int64_t next = fire(warp_now());
    pthread_mutex_unlock(&lock);
    struct timespec wall;
    if (next != WARP_FOREVER) {
      int64_t left = warp_wall_until(next);
      wall = warp_to_spec(left > 0 ? left : 1);
    }
    syscall(SYS_futex, &changes, FUTEX_WAIT_PRIVATE, seen, next == WARP_FOREVER ? NULL : &wall, NULL, 0);
  }
  return nothing;
}

static void in_child(void) {
  pthread_mutex_init(&lock, NULL);
  thread_runs = 0;
  timers[0].deadline = 0;
  for (int i = 1; i < TIMERS; i++) timers[i].used = 0;
}

// With the lock held: all signals are blocked, and stay so in the thread.
static int start_thread(void) {
  static int registered;
  pthread_t thread;
  pthread_attr_t attributes;
  if (thread_runs) return 0;
  if (!registered) pthread_atfork(NULL, NULL, in_child);
  registered = 1;
  pthread_attr_init(&attributes);
  pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
  pthread_attr_setstacksize(&attributes, 1 << 17);
  int error = pthread_create(&thread, &attributes, send_signals, NULL);
  pthread_attr_destroy(&attributes);
  thread_runs = !error;
  return error;
}

static struct itimerspec left_of(const struct signal_timer *t) {
  int64_t left = t->deadline ? t->deadline - warp_now() : 0;
  if (t->deadline && left < 1) left = 1;
  return (struct itimerspec){.it_interval = warp_to_spec(t->interval), .it_value = warp_to_spec(left)};
}

static int set(struct signal_timer *t, int64_t deadline, int64_t interval, struct itimerspec *before) {
  if (before) *before = left_of(t);
  int error = deadline ? start_thread() : 0;
  if (error) {
    errno = error;
    return -1;
  }
  t->deadline = deadline;
  t->interval = interval;
  __atomic_add_fetch(&changes, 1, __ATOMIC_SEQ_CST);
  syscall(SYS_futex, &changes, FUTEX_WAKE_PRIVATE, INT_MAX, NULL, NULL, 0);
  return 0;
}

static struct signal_timer *find(timer_t id) {
  for (int i = 1; i < TIMERS; i++)
    if (timers[i].used && timers[i].id == id) return &timers[i];
  return NULL;
}

static int64_t from_timeval(struct timeval t) { return t.tv_sec * WARP_SECOND + t.tv_usec * 1000ll; }

static struct itimerval to_itimerval(struct itimerspec t) {
  return (struct itimerval){
      .it_interval = {t.it_interval.tv_sec, t.it_interval.tv_nsec / 1000},
      .it_value = {t.it_value.tv_sec, (t.it_value.tv_nsec + 999) / 1000 % 1000000},
  };
}

static int is_time(struct timeval t) { return t.tv_sec >= 0 && t.tv_usec >= 0 && t.tv_usec < 1000000; }

int setitimer(__itimer_which_t which, const struct itimerval *restrict next, struct itimerval *restrict before) {
  WARP_REAL(int, setitimer, __itimer_which_t, const struct itimerval *, struct itimerval *);
  if (!warp_active() || which != ITIMER_REAL || !next || !is_time(next->it_value) || !is_time(next->it_interval))
    return real_setitimer(which, next, before);
  int64_t length = from_timeval(next->it_value);
  struct itimerspec left;
  sigset_t mask;
  take(&mask);
  int result = set(&timers[0], length ? warp_after(length) : 0, from_timeval(next->it_interval), &left);
  give(&mask);
  if (!result && before) *before = to_itimerval(left);
  return result;
}

int getitimer(__itimer_which_t which, struct itimerval *now) {
  WARP_REAL(int, getitimer, __itimer_which_t, struct itimerval *);
  if (!warp_active() || which != ITIMER_REAL) return real_getitimer(which, now);
  sigset_t mask;
  take(&mask);
  *now = to_itimerval(left_of(&timers[0]));
  give(&mask);
  return 0;
}

unsigned int alarm(unsigned int seconds) {
  struct itimerval before, next = {.it_value = {.tv_sec = seconds}};
  if (setitimer(ITIMER_REAL, &next, &before) != 0) return 0;
  return (unsigned int)(before.it_value.tv_sec + (before.it_value.tv_usec > 0));
}

int timer_create(clockid_t clock, struct sigevent *restrict event, timer_t *restrict id) {
  WARP_REAL(int, timer_create, clockid_t, struct sigevent *, timer_t *);
  if (!warp_active() || !warp_is_warped(clock) || (event && event->sigev_notify != SIGEV_SIGNAL))
    return real_timer_create(clock, event, id);
  struct sigevent silent = {.sigev_notify = SIGEV_NONE};
  int result = real_timer_create(clock, &silent, id);
  if (result) return result;
  sigset_t mask;
  take(&mask);
  int i = 1;
  while (i < TIMERS && timers[i].used) i++;
  if (i < TIMERS) {
    union sigval own = {.sival_ptr = *id};
    timers[i] = (struct signal_timer){
        .used = 1, .id = *id, .number = event ? event->sigev_signo : SIGALRM, .value = event ? event->sigev_value : own};
  }
  give(&mask);
  if (i < TIMERS) return 0;
  WARP_REAL(int, timer_delete, timer_t);
  real_timer_delete(*id);
  errno = EAGAIN;
  return -1;
}

// 1 and the result when the timer is one of ours.
int warp_set_signal_timer(timer_t id, int64_t deadline, int64_t interval, struct itimerspec *before, int *result) {
  sigset_t mask;
  take(&mask);
  struct signal_timer *t = find(id);
  if (t) *result = set(t, deadline, interval, before);
  give(&mask);
  return t != NULL;
}

int timer_gettime(timer_t id, struct itimerspec *now) {
  WARP_REAL(int, timer_gettime, timer_t, struct itimerspec *);
  sigset_t mask;
  take(&mask);
  struct signal_timer *t = find(id);
  if (t) *now = left_of(t);
  give(&mask);
  if (t) return 0;
  int result = real_timer_gettime(id, now);
  if (!result && warp_active()) {
    now->it_interval = warp_to_spec(warp_sim_length(warp_from_spec(&now->it_interval)));
    now->it_value = warp_to_spec(warp_sim_length(warp_from_spec(&now->it_value)));
  }
  return result;
}

int timer_delete(timer_t id) {
  WARP_REAL(int, timer_delete, timer_t);
  sigset_t mask;
  take(&mask);
  struct signal_timer *t = find(id);
  if (t) t->used = 0;
  give(&mask);
  return real_timer_delete(id);
}
