// SPDX-License-Identifier: BSD-3-Clause
// The two clocks the kernel keeps inside a socket: its time-outs, and TCP's small delays.
#define _GNU_SOURCE
#include "clock.h"

#include <errno.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

// TCP holds back a small packet until the one before is acknowledged, which the other side may put off for 40 ms of wall
// time: two simulated seconds at 50x, in which a heartbeat is missed. At 1x nobody can tell whether it does.
int socket(int domain, int type, int protocol) {
  WARP_REAL(int, socket, int, int, int);
  int fd = real_socket(domain, type, protocol);
  int kind = type & ~(SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd >= 0 && warp_active() && kind == SOCK_STREAM && (domain == AF_INET || domain == AF_INET6)) {
    WARP_REAL(int, setsockopt, int, int, int, const void *, socklen_t);
    int saved = errno, on = 1;
    real_setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    errno = saved;
  }
  return fd;
}

int setsockopt(int fd, int level, int option, const void *value, socklen_t size) {
  WARP_REAL(int, setsockopt, int, int, int, const void *, socklen_t);
  if (warp_active() && level == SOL_SOCKET && (option == SO_RCVTIMEO || option == SO_SNDTIMEO) &&
      size == sizeof(struct timeval)) {
    struct timeval wall = warp_wall_timeval(*(const struct timeval *)value);
    return real_setsockopt(fd, level, option, &wall, size);
  }
  return real_setsockopt(fd, level, option, value, size);
}
