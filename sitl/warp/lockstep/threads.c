// SPDX-License-Identifier: BSD-3-Clause
// The program's threads, as coroutines of its main thread: they run between two steps, one after the other, up to where
// they wait. So it does not depend on the machine in which order threads run.
#define _GNU_SOURCE
#include "lockstep.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <ucontext.h>

#define THREADS 16
#define STACK (1 << 20)

struct thread {
  ucontext_t own, caller;
  void *(*run)(void *);
  void *given, *result;
  int fd; // where it waits; -1: for the machine's sockets
  int done;
};
static struct thread threads[THREADS];
static int count, ending;
static struct thread *running;

int lockstep_in_thread(void) { return running != NULL; }

int lockstep_is_ending(void) { return ending; }

static void begin(int index) {
  struct thread *t = &threads[index];
  t->result = t->run(t->given);
  t->done = 1;
}

static void resume(struct thread *t) {
  if (t->done) return;
  struct thread *before = running;
  running = t;
  swapcontext(&t->caller, &t->own);
  running = before;
}

void lockstep_yield(int fd) {
  struct thread *t = running;
  t->fd = fd;
  swapcontext(&t->own, &t->caller);
}

void lockstep_resume(int fd) {
  for (int i = 0; i < count; i++)
    if (threads[i].fd == fd) resume(&threads[i]);
}

int pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*run)(void *), void *given) {
  LOCKSTEP_REAL(int, pthread_create, pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
  if (!lockstep_active()) return real_pthread_create(id, attributes, run, given);
  if (count == THREADS) return EAGAIN;
  struct thread *t = &threads[count];
  void *stack = malloc(STACK);
  if (!stack) return EAGAIN;
  getcontext(&t->own);
  t->own.uc_stack.ss_sp = stack;
  t->own.uc_stack.ss_size = STACK;
  t->own.uc_link = &t->caller;
  t->run = run;
  t->given = given;
  t->fd = -1;
  makecontext(&t->own, (void (*)(void))begin, 1, count);
  *id = (pthread_t)t;
  count++;
  resume(t);
  return 0;
}

int pthread_join(pthread_t id, void **result) {
  LOCKSTEP_REAL(int, pthread_join, pthread_t, void **);
  struct thread *t = (struct thread *)id;
  if (!lockstep_active() || t < threads || t >= threads + count) return real_pthread_join(id, result);
  ending = 1; // whoever waits for something goes on without it, and sees that the program ends
  while (!t->done) resume(t);
  if (result) *result = t->result;
  return 0;
}
