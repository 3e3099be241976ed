// SPDX-License-Identifier: BSD-3-Clause
// Programs that a preloaded library cannot reach: a static `mavsdk_server` is started through the runtime in
// sitl/warp/static, which puts it on the same clock. Other programs start as they are.
#define _GNU_SOURCE
#include "clock.h"

#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define ARGUMENTS_MAX 1024

static char runtime[4096]; // path of the runtime; empty if there is none. Read in children of vfork: must not move.

__attribute__((constructor)) static void find_runtime(void) {
  const char *path = getenv("SITL_WARP_RUNTIME");
  if (path && strlen(path) < sizeof runtime) strcpy(runtime, path);
}

// 1 if `path` is a program for the runtime. Nothing here allocates: it runs between vfork and exec.
static int wants_runtime(const char *path) {
  if (!path || !runtime[0] || !warp_active()) return 0;
  const char *slash = strrchr(path, '/');
  return !strncmp(slash ? slash + 1 : path, "mavsdk_server", 13) && access(path, X_OK) == 0;
}

// Writes {runtime, path, argv...} to `out`; 0 if there are too many arguments.
static int with_runtime(const char *path, char *const argv[], char *out[ARGUMENTS_MAX + 3]) {
  int n = 0;
  while (argv[n])
    if (++n > ARGUMENTS_MAX) return 0;
  out[0] = runtime;
  out[1] = (char *)path;
  memcpy(out + 2, argv, (size_t)(n + 1) * sizeof *argv);
  return 1;
}

int execve(const char *path, char *const argv[], char *const envp[]) {
  WARP_REAL(int, execve, const char *, char *const[], char *const[]);
  char *longer[ARGUMENTS_MAX + 3];
  if (wants_runtime(path) && with_runtime(path, argv, longer)) return real_execve(runtime, longer, envp);
  return real_execve(path, argv, envp);
}

int execv(const char *path, char *const argv[]) { return execve(path, argv, environ); }

int posix_spawn(pid_t *restrict pid, const char *restrict path, const posix_spawn_file_actions_t *actions,
                const posix_spawnattr_t *restrict attributes, char *const argv[restrict], char *const envp[restrict]) {
  WARP_REAL(int, posix_spawn, pid_t *, const char *, const posix_spawn_file_actions_t *, const posix_spawnattr_t *,
            char *const[], char *const[]);
  char *longer[ARGUMENTS_MAX + 3];
  if (wants_runtime(path) && with_runtime(path, argv, longer))
    return real_posix_spawn(pid, runtime, actions, attributes, longer, envp);
  return real_posix_spawn(pid, path, actions, attributes, argv, envp);
}

int posix_spawnp(pid_t *restrict pid, const char *restrict file, const posix_spawn_file_actions_t *actions,
                 const posix_spawnattr_t *restrict attributes, char *const argv[restrict],
                 char *const envp[restrict]) {
  WARP_REAL(int, posix_spawnp, pid_t *, const char *, const posix_spawn_file_actions_t *, const posix_spawnattr_t *,
            char *const[], char *const[]);
  if (strchr(file, '/')) return posix_spawn(pid, file, actions, attributes, argv, envp);
  return real_posix_spawnp(pid, file, actions, attributes, argv, envp);
}
