// SPDX-License-Identifier: BSD-3-Clause
// What differs between processors. Everything in this folder is free-standing: no C library, no thread-local storage,
// because it runs inside programs that bring a C library of their own.
#ifndef SITL_STATIC_MACHINE_H
#define SITL_STATIC_MACHINE_H

#include <stddef.h>
#include <stdint.h>
#include <sys/syscall.h>
#include <ucontext.h>

#define HIDDEN __attribute__((visibility("hidden")))

// The one system call instruction of this runtime; the filter lets calls pass that return to warp_syscall_return.
HIDDEN long warp_syscall(long number, long a, long b, long c, long d, long e, long f);
extern HIDDEN const char warp_syscall_return[];

#if defined(__x86_64__)
#define MACHINE_AUDIT 0xc000003eu /* AUDIT_ARCH_X86_64 */
#define MACHINE_ELF 62
#define MACHINE_RELATIVE 8 /* R_X86_64_RELATIVE */
#define CONTEXT_RESULT(u) ((u)->uc_mcontext.gregs[REG_RAX])
#define CONTEXT_ARGUMENTS(u)                                                                                   \
  {(long)(u)->uc_mcontext.gregs[REG_RDI], (long)(u)->uc_mcontext.gregs[REG_RSI],                               \
   (long)(u)->uc_mcontext.gregs[REG_RDX], (long)(u)->uc_mcontext.gregs[REG_R10],                               \
   (long)(u)->uc_mcontext.gregs[REG_R8], (long)(u)->uc_mcontext.gregs[REG_R9]}
#elif defined(__aarch64__)
#define MACHINE_AUDIT 0xc00000b7u /* AUDIT_ARCH_AARCH64 */
#define MACHINE_ELF 183
#define MACHINE_RELATIVE 1027 /* R_AARCH64_RELATIVE */
#define CONTEXT_RESULT(u) ((u)->uc_mcontext.regs[0])
#define CONTEXT_ARGUMENTS(u)                                                                                   \
  {(long)(u)->uc_mcontext.regs[0], (long)(u)->uc_mcontext.regs[1], (long)(u)->uc_mcontext.regs[2],             \
   (long)(u)->uc_mcontext.regs[3], (long)(u)->uc_mcontext.regs[4], (long)(u)->uc_mcontext.regs[5]}
#else
#error "static programs on simulated time: only x86-64 and aarch64 are written"
#endif

#define CALL(number, ...) CALL_(number, __VA_ARGS__, 0, 0, 0, 0, 0, 0)
#define CALL_(number, a, b, c, d, e, f, ...) \
  warp_syscall((number), (long)(a), (long)(b), (long)(c), (long)(d), (long)(e), (long)(f))

// runtime.c
HIDDEN int warp_attach(const char *page_path);
HIDDEN int warp_take_over(void);
HIDDEN const void *warp_fake_vdso(void);

#endif
