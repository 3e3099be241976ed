// SPDX-License-Identifier: BSD-3-Clause
// The lockstep library's own functions, for its other files. What it does and its messages: sitl/warp/held_clock.py.
#ifndef SITL_LOCKSTEP_H
#define SITL_LOCKSTEP_H

#include <stddef.h>
#include <stdint.h>
#include <sys/select.h>

#define LOCKSTEP_MESSAGE 65536 // [bytes] greatest message of either side
#define LOCKSTEP_FDS 1024      // as many as select() takes

// 1 when a simulator holds the clock, else every function of this library is the C library's own.
int lockstep_active(void);
// Appends a datagram to the answer of this step; drops it when there is no room.
void lockstep_answer(uint16_t port, const void *data, size_t size);

// Hands a datagram to the thread that waits for it.
void lockstep_deliver(uint16_t port, const void *data, size_t size);
// The descriptor of a datagram socket that this thread would wait for, or -1.
int lockstep_virtual(int count, const fd_set *read);
// Whether a datagram waits at such a descriptor.
int lockstep_has(int fd);

// 1 in one of the program's threads, 0 in its main thread.
int lockstep_in_thread(void);
// 1 once the program waits for its threads to end.
int lockstep_is_ending(void);
// Lets other threads go on; returns when this one is due again.
void lockstep_yield(int fd);
// Lets the thread that waits at this descriptor go on until it waits again; -1: all that wait for the machine's sockets.
void lockstep_resume(int fd);

// The C library's own `name`; found once.
void *lockstep_next(const char *name);
#define LOCKSTEP_REAL(result, name, ...)    \
  static result (*real_##name)(__VA_ARGS__); \
  if (__builtin_expect(!real_##name, 0)) real_##name = lockstep_next(#name)

#endif
