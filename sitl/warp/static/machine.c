// SPDX-License-Identifier: BSD-3-Clause
// Entry point, system call instruction and return from signal handlers, per processor.
#include "machine.h"

#if defined(__x86_64__)
__asm__(".text\n"
        ".globl _start\n.type _start,@function\n"
        "_start:\n"
        "  mov %rsp, %rdi\n"
        "  mov %rsp, %rbx\n"
        "  and $-16, %rsp\n"
        "  call warp_start\n" // returns the program's entry point; its arguments begin two words further
        "  lea 16(%rbx), %rsp\n"
        "  xor %edx, %edx\n"
        "  xor %ebp, %ebp\n"
        "  jmp *%rax\n"
        ".globl warp_syscall\n.hidden warp_syscall\n.type warp_syscall,@function\n"
        "warp_syscall:\n"
        "  mov %rdi, %rax\n  mov %rsi, %rdi\n  mov %rdx, %rsi\n  mov %rcx, %rdx\n"
        "  mov %r8, %r10\n  mov %r9, %r8\n  mov 8(%rsp), %r9\n"
        "  syscall\n"
        ".globl warp_syscall_return\n.hidden warp_syscall_return\n"
        "warp_syscall_return:\n"
        "  ret\n"
        ".globl warp_restorer\n.hidden warp_restorer\n.type warp_restorer,@function\n"
        "  nop\n"
        "warp_restorer:\n"
        "  mov $15, %eax\n" // rt_sigreturn
        "  syscall\n");
#elif defined(__aarch64__)
__asm__(".text\n"
        ".globl _start\n.type _start,%function\n"
        "_start:\n"
        "  mov x0, sp\n"
        "  mov x19, sp\n"
        "  bl warp_start\n"
        "  mov x16, x0\n"
        "  add sp, x19, #16\n"
        "  mov x0, #0\n  mov x29, #0\n  mov x30, #0\n"
        "  br x16\n"
        ".globl warp_syscall\n.hidden warp_syscall\n.type warp_syscall,%function\n"
        "warp_syscall:\n"
        "  mov x8, x0\n  mov x0, x1\n  mov x1, x2\n  mov x2, x3\n  mov x3, x4\n  mov x4, x5\n  mov x5, x6\n"
        "  svc #0\n"
        ".globl warp_syscall_return\n.hidden warp_syscall_return\n"
        "warp_syscall_return:\n"
        "  ret\n"
        ".globl warp_restorer\n.hidden warp_restorer\n.type warp_restorer,%function\n"
        "  nop\n"
        "warp_restorer:\n"
        "  mov x8, #139\n"
        "  svc #0\n");
#endif

// Compilers put in calls to these where none is written.
void *memcpy(void *restrict to, const void *restrict from, size_t n) {
  volatile char *t = to;
  for (const char *f = from; n--;) *t++ = *f++;
  return to;
}

void *memset(void *to, int value, size_t n) {
  for (volatile char *t = to; n--;) *t++ = (char)value;
  return to;
}
