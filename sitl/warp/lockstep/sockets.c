// SPDX-License-Identifier: BSD-3-Clause
// The program's sockets. Datagrams go through the simulator's messages, so that its ports are free for others; TCP ports
// are others of this machine, and the first client of one of them is the simulator.
#define _GNU_SOURCE
#include "lockstep.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static struct {
  int is_datagram;
  uint16_t port; // where it listens; 0: nowhere
  size_t size;   // of what waits; 0: nothing does
  uint8_t data[2048];
} sockets[LOCKSTEP_FDS];
static int listener = -1; // the TCP socket whose first client is the simulator

static int is_virtual(int fd) { return fd >= 0 && fd < LOCKSTEP_FDS && sockets[fd].is_datagram; }

static int number(const char *name, int otherwise) {
  const char *text = getenv(name);
  return text ? atoi(text) : otherwise;
}

int lockstep_has(int fd) { return sockets[fd].size > 0; }

int lockstep_virtual(int count, const fd_set *read) {
  for (int fd = 0; read && fd < count && fd < LOCKSTEP_FDS; fd++)
    if (FD_ISSET(fd, read) && is_virtual(fd)) return fd;
  return -1;
}

void lockstep_deliver(uint16_t port, const void *data, size_t size) {
  for (int fd = 0; fd < LOCKSTEP_FDS; fd++) {
    if (!sockets[fd].is_datagram || sockets[fd].port != port || size > sizeof sockets[fd].data) continue;
    memcpy(sockets[fd].data, data, size);
    sockets[fd].size = size;
    lockstep_resume(fd);
    return;
  }
}

int socket(int domain, int type, int protocol) {
  LOCKSTEP_REAL(int, socket, int, int, int);
  int fd = real_socket(domain, type, protocol);
  int kind = type & ~(SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (lockstep_active() && fd >= 0 && fd < LOCKSTEP_FDS) {
    memset(&sockets[fd], 0, sizeof sockets[fd]);
    sockets[fd].is_datagram = kind == SOCK_DGRAM && domain == AF_INET;
  }
  return fd;
}

int close(int fd) {
  LOCKSTEP_REAL(int, close, int);
  if (lockstep_active() && fd >= 0 && fd < LOCKSTEP_FDS) sockets[fd].is_datagram = 0;
  return real_close(fd);
}

// TCP ports go to this machine only, where the simulator says; without a word of it to any free one.
static uint16_t moved(int fd, uint16_t port) {
  int first = number("SITL_LOCKSTEP_TCP", 0), base = number("SITL_LOCKSTEP_TCP_FROM", 0);
  if (port == number("SITL_LOCKSTEP_SERIAL", -1)) {
    listener = fd;
    return 0;
  }
  return first && base && port >= base ? (uint16_t)(first + port - base) : 0;
}

int bind(int fd, const struct sockaddr *address, socklen_t size) {
  LOCKSTEP_REAL(int, bind, int, const struct sockaddr *, socklen_t);
  if (!lockstep_active()) return real_bind(fd, address, size);
  if (address->sa_family == AF_INET && size >= sizeof(struct sockaddr_in)) {
    struct sockaddr_in here = *(const struct sockaddr_in *)address;
    uint16_t port = ntohs(here.sin_port);
    if (is_virtual(fd)) {
      sockets[fd].port = port;
      return 0;
    }
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    here.sin_port = htons(moved(fd, port));
    return real_bind(fd, (struct sockaddr *)&here, sizeof here);
  }
  if (address->sa_family == AF_INET6 && size >= sizeof(struct sockaddr_in6)) {
    struct sockaddr_in6 here = *(const struct sockaddr_in6 *)address;
    here.sin6_addr = (struct in6_addr){{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 127, 0, 0, 1}}}; // takes IPv4
    here.sin6_port = htons(moved(fd, ntohs(here.sin6_port)));
    return real_bind(fd, (struct sockaddr *)&here, sizeof here);
  }
  return real_bind(fd, address, size);
}

ssize_t sendto(int fd, const void *data, size_t size, int flags, const struct sockaddr *to, socklen_t length) {
  LOCKSTEP_REAL(ssize_t, sendto, int, const void *, size_t, int, const struct sockaddr *, socklen_t);
  if (!lockstep_active() || !is_virtual(fd) || !to) return real_sendto(fd, data, size, flags, to, length);
  lockstep_answer(ntohs(((const struct sockaddr_in *)to)->sin_port), data, size);
  return (ssize_t)size;
}

ssize_t recvfrom(int fd, void *restrict data, size_t size, int flags, struct sockaddr *restrict from,
                 socklen_t *restrict length) {
  LOCKSTEP_REAL(ssize_t, recvfrom, int, void *, size_t, int, struct sockaddr *, socklen_t *);
  if (!lockstep_active() || !is_virtual(fd)) return real_recvfrom(fd, data, size, flags, from, length);
  size_t there = sockets[fd].size;
  if (!there) {
    errno = EAGAIN;
    return -1;
  }
  if (size > there) size = there;
  memcpy(data, sockets[fd].data, size);
  sockets[fd].size = 0;
  if (from && length && *length >= sizeof(struct sockaddr_in)) {
    struct sockaddr_in simulator = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    memcpy(from, &simulator, sizeof simulator);
    *length = sizeof simulator;
  }
  return (ssize_t)size;
}

static int nothing(fd_set *read, fd_set *write, fd_set *except) {
  if (read) FD_ZERO(read);
  if (write) FD_ZERO(write);
  if (except) FD_ZERO(except);
  return 0;
}

int select(int count, fd_set *read, fd_set *write, fd_set *except, struct timeval *timeout) {
  LOCKSTEP_REAL(int, select, int, fd_set *, fd_set *, fd_set *, struct timeval *);
  if (!lockstep_active() || !lockstep_in_thread()) return real_select(count, read, write, except, timeout);
  int fd = lockstep_virtual(count, read);
  if (fd >= 0) {
    while (!lockstep_has(fd) && !lockstep_is_ending()) lockstep_yield(fd);
    if (!lockstep_has(fd)) return nothing(read, write, except);
    nothing(read, write, except);
    FD_SET(fd, read);
    return 1;
  }
  if (!lockstep_is_ending()) lockstep_yield(-1);
  int is_awaited = listener >= 0 && listener < count && read && FD_ISSET(listener, read) && number("SITL_LOCKSTEP_SERIAL_FD", -1) >= 0;
  struct timeval at_once = {0, 0};
  int found = real_select(count, read, write, except, &at_once);
  if (found < 0) found = nothing(read, write, except);
  if (is_awaited) FD_SET(listener, read);
  return found + is_awaited;
}

int accept(int fd, struct sockaddr *restrict address, socklen_t *restrict size) {
  LOCKSTEP_REAL(int, accept, int, struct sockaddr *, socklen_t *);
  int serial = number("SITL_LOCKSTEP_SERIAL_FD", -1);
  if (!lockstep_active() || fd != listener || serial < 0) return real_accept(fd, address, size);
  unsetenv("SITL_LOCKSTEP_SERIAL_FD");
  return serial;
}
