// SPDX-License-Identifier: BSD-3-Clause
// Makes the kernel hand us the system calls in waits.c: a seccomp filter turns them into a SIGSYS in the thread that
// made them, its handler does the work and leaves the result where the program expects it. Needs no privilege.
#define _GNU_SOURCE
#include "machine.h"

#include <linux/filter.h>
#include <linux/futex.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>

long warp_handle(long number, const long arguments[6]) HIDDEN;
extern HIDDEN const char warp_restorer[];

#define FIELD(f) ((uint32_t)offsetof(struct seccomp_data, f))
#define LOW(n) (FIELD(args) + 8 * (n))
#define HIGH(n) (LOW(n) + 4)
#define LOAD(at) BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (at))
#define IF(op, value, yes, no) BPF_JUMP(BPF_JMP | (op) | BPF_K, (uint32_t)(value), (yes), (no))
#define ALLOW BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)
#define TRAP BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP)

// Each of these is a whole little decision for one system call; A holds its number before and after.
#define ALWAYS(n) IF(BPF_JEQ, n, 0, 1), TRAP
#define WITH_POINTER(n, i) /* a time-out structure is given */                                                  \
  IF(BPF_JEQ, n, 0, 6), LOAD(LOW(i)), IF(BPF_JEQ, 0, 0, 2), LOAD(HIGH(i)), IF(BPF_JEQ, 0, 1, 0), TRAP, ALLOW
#define WITH_MILLISECONDS(n, i) /* more than zero; negative is for ever */                                      \
  IF(BPF_JEQ, n, 0, 5), LOAD(LOW(i)), IF(BPF_JSET, 0x80000000u, 2, 0), IF(BPF_JEQ, 0, 1, 0), TRAP, ALLOW

static void on_sigsys(int number, siginfo_t *info, void *context) {
  (void)number;
  ucontext_t *u = context;
  long a[6] = CONTEXT_ARGUMENTS(u);
  if (info->si_syscall == SYS_rt_sigprocmask) {
    // A blocked SIGSYS would end the program at its next wait. The mask changes when this handler returns.
    uint64_t set = *(const uint64_t *)a[1] & ~(1ull << (SIGSYS - 1)), *mask = (uint64_t *)&u->uc_sigmask;
    if (a[2]) *(uint64_t *)a[2] = *mask;
    *mask = a[0] == SIG_BLOCK ? *mask | set : a[0] == SIG_UNBLOCK ? *mask & ~set : set;
    CONTEXT_RESULT(u) = 0;
    return;
  }
  CONTEXT_RESULT(u) = warp_handle(info->si_syscall, a);
}

int warp_take_over(void) {
  struct {
    void (*handler)(int, siginfo_t *, void *);
    unsigned long flags;
    const void *restorer;
    uint64_t mask;
  } action = {on_sigsys, SA_SIGINFO | SA_NODEFER | SA_ONSTACK | 0x04000000 /* SA_RESTORER */, warp_restorer, 0};
  if (CALL(SYS_rt_sigaction, SIGSYS, &action, 0, 8)) return 0;

  uint64_t here = (uint64_t)(uintptr_t)warp_syscall_return;
  struct sock_filter program[] = {
      LOAD(FIELD(arch)), IF(BPF_JEQ, MACHINE_AUDIT, 1, 0), ALLOW,
      LOAD(FIELD(instruction_pointer)), IF(BPF_JEQ, (uint32_t)here, 0, 3),
      LOAD(FIELD(instruction_pointer) + 4), IF(BPF_JEQ, here >> 32, 0, 1), ALLOW,
      LOAD(FIELD(nr)),
      // The commonest first: most futex calls wake, or wait without a time-out.
      IF(BPF_JEQ, SYS_futex, 0, 11), LOAD(LOW(1)), BPF_STMT(BPF_ALU | BPF_AND | BPF_K, FUTEX_CMD_MASK),
      IF(BPF_JEQ, FUTEX_WAIT, 2, 0), IF(BPF_JEQ, FUTEX_WAIT_BITSET, 1, 0), ALLOW,
      LOAD(LOW(3)), IF(BPF_JEQ, 0, 0, 2), LOAD(HIGH(3)), IF(BPF_JEQ, 0, 1, 0), TRAP, ALLOW,
      WITH_MILLISECONDS(SYS_epoll_pwait, 3), WITH_POINTER(SYS_epoll_pwait2, 3),
      WITH_POINTER(SYS_ppoll, 2), WITH_POINTER(SYS_pselect6, 4),
#ifdef SYS_epoll_wait
      WITH_MILLISECONDS(SYS_epoll_wait, 3), WITH_MILLISECONDS(SYS_poll, 2), WITH_POINTER(SYS_select, 4),
      ALWAYS(SYS_time),
#endif
      ALWAYS(SYS_clock_gettime), ALWAYS(SYS_gettimeofday), ALWAYS(SYS_nanosleep), ALWAYS(SYS_clock_nanosleep),
      ALWAYS(SYS_timerfd_settime), ALWAYS(SYS_socket), WITH_POINTER(SYS_rt_sigprocmask, 1),
      IF(BPF_JEQ, SYS_setsockopt, 0, 7), LOAD(LOW(1)), IF(BPF_JEQ, SOL_SOCKET, 0, 4),
      LOAD(LOW(2)), IF(BPF_JEQ, SO_RCVTIMEO, 1, 0), IF(BPF_JEQ, SO_SNDTIMEO, 0, 1), TRAP, ALLOW,
      ALLOW,
  };
  struct sock_fprog filter = {sizeof program / sizeof *program, program};
  if (CALL(SYS_prctl, PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)) return 0;
  return CALL(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &filter) == 0;
}
