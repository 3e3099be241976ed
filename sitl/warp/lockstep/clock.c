// SPDX-License-Identifier: BSD-3-Clause
// The clock that the simulator gives out step by step. It goes on when the main thread sleeps or looks at it, and what
// would go beyond the step waits for the next one: nothing depends on how fast the machine is.
#define _GNU_SOURCE
#include "lockstep.h"

#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#define SECOND 1000000000ll
#define LOOK 100ll        // [ns] that pass when the main thread looks at the clock: a loop that waits for a time ends
#define TURN 10000000ll   // [ns] between two turns of threads that wait for the machine's sockets

static int channel = -1;
static int64_t now = SECOND;   // of the main thread
static int64_t until = SECOND; // end of the step
static int64_t turned = 0;     // when threads that wait for the machine's sockets had their last turn
static uint8_t out[LOCKSTEP_MESSAGE], in[LOCKSTEP_MESSAGE];
static size_t out_size = sizeof now;

void *lockstep_next(const char *name) { return dlsym(RTLD_NEXT, name); }

__attribute__((constructor)) static void attach(void) {
  const char *text = getenv("SITL_LOCKSTEP_FD");
  if (text) channel = atoi(text);
}

int lockstep_active(void) { return channel >= 0; }

void lockstep_answer(uint16_t port, const void *data, size_t size) {
  uint16_t head[2] = {port, (uint16_t)size};
  if (size > UINT16_MAX || out_size + sizeof head + size > sizeof out) return;
  memcpy(out + out_size, head, sizeof head);
  memcpy(out + out_size + sizeof head, data, size);
  out_size += sizeof head + size;
}

// The step is done: says so, waits for the next one, and hands out what came with it.
static void exchange(void) {
  memcpy(out, &until, sizeof until);
  ssize_t n;
  do n = send(channel, out, out_size, MSG_NOSIGNAL);
  while (n < 0 && errno == EINTR);
  out_size = sizeof until;
  do n = recv(channel, in, sizeof in, 0);
  while (n < 0 && errno == EINTR);
  if (n < (ssize_t)sizeof until) _exit(0); // the simulator is gone
  int64_t next;
  memcpy(&next, in, sizeof next);
  for (size_t at = sizeof next; at + 4 <= (size_t)n;) {
    uint16_t head[2];
    memcpy(head, in + at, sizeof head);
    at += sizeof head;
    if (at + head[1] > (size_t)n) break;
    lockstep_deliver(head[0], in + at, head[1]);
    at += head[1];
  }
  if (until >= turned + TURN) {
    turned = until;
    lockstep_resume(-1);
  }
  until = next;
}

static void go_on(int64_t ns) {
  if (lockstep_in_thread()) return; // their time is the beginning of the step
  now += ns;
  while (now >= until) exchange();
}

// Threads run between two steps: for them it is exactly the end of the one before.
static int64_t read_clock(void) {
  if (lockstep_in_thread()) return until;
  now += LOOK;
  return now;
}

int clock_gettime(clockid_t id, struct timespec *to) {
  LOCKSTEP_REAL(int, clock_gettime, clockid_t, struct timespec *);
  if (!lockstep_active() || id == CLOCK_PROCESS_CPUTIME_ID || id == CLOCK_THREAD_CPUTIME_ID)
    return real_clock_gettime(id, to);
  int64_t ns = read_clock();
  *to = (struct timespec){.tv_sec = ns / SECOND, .tv_nsec = ns % SECOND};
  return 0;
}

int gettimeofday(struct timeval *restrict to, void *restrict zone) {
  LOCKSTEP_REAL(int, gettimeofday, struct timeval *, void *);
  if (!lockstep_active()) return real_gettimeofday(to, zone);
  int64_t ns = read_clock();
  *to = (struct timeval){.tv_sec = ns / SECOND, .tv_usec = ns % SECOND / 1000};
  return 0;
}

time_t time(time_t *to) {
  struct timeval t;
  gettimeofday(&t, NULL);
  if (to) *to = t.tv_sec;
  return t.tv_sec;
}

int nanosleep(const struct timespec *t, struct timespec *left) {
  LOCKSTEP_REAL(int, nanosleep, const struct timespec *, struct timespec *);
  if (!lockstep_active()) return real_nanosleep(t, left);
  go_on((int64_t)t->tv_sec * SECOND + t->tv_nsec);
  return 0;
}

int clock_nanosleep(clockid_t id, int flags, const struct timespec *t, struct timespec *left) {
  LOCKSTEP_REAL(int, clock_nanosleep, clockid_t, int, const struct timespec *, struct timespec *);
  if (!lockstep_active()) return real_clock_nanosleep(id, flags, t, left);
  int64_t ns = (int64_t)t->tv_sec * SECOND + t->tv_nsec;
  if (flags & TIMER_ABSTIME) ns -= now;
  if (ns > 0) go_on(ns);
  return 0;
}

int usleep(useconds_t us) {
  struct timespec t = {us / 1000000u, (long)(us % 1000000u) * 1000};
  return nanosleep(&t, NULL);
}
