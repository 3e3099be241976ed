// SPDX-License-Identifier: BSD-3-Clause
// For the simulator's side (loaded with ctypes, not preloaded): is any thread of the scripts' processes at work?
// The kernel knows at every moment: a thread whose timer ran out or whose socket got a packet is "running" from then on,
// even before a processor takes it up. So a simulator that has just sent something cannot mistake the script for idle.
#define _GNU_SOURCE
#include "clock.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// The state letter in /proc/PID/task/TID/stat, 0 if the thread is gone.
static char state_of(int folder, const char *thread) {
  char path[300], text[128];
  snprintf(path, sizeof path, "%s/stat", thread);
  int fd = openat(folder, path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return 0;
  ssize_t n = read(fd, text, sizeof text - 1);
  close(fd);
  if (n <= 0) return 0;
  text[n] = 0;
  const char *end = strrchr(text, ')');
  return end && end[1] ? end[2] : 0;
}

// 1 if a thread of process `pid` is running or waits for a disk, 0 if all sleep, -1 if the process is gone.
int sitl_clock_busy(int pid) {
  char path[32];
  snprintf(path, sizeof path, "/proc/%d/task", pid);
  DIR *folder = opendir(path);
  if (!folder) return -1;
  int busy = 0, any = 0;
  for (struct dirent *entry; !busy && (entry = readdir(folder));) {
    if (entry->d_name[0] == '.') continue;
    char state = state_of(dirfd(folder), entry->d_name);
    if (state == 'R' || state == 'D') busy = 1;
    if (state && state != 'Z' && state != 'X') any = 1;
  }
  closedir(folder);
  return busy ? 1 : any ? 0 : -1;
}
