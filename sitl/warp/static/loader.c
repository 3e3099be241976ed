// SPDX-License-Identifier: BSD-3-Clause
// Usage: sitl-static-runtime PROGRAM ARGV0 [ARGV1...]
// Becomes PROGRAM: maps it as the kernel would, puts its clock on the page named by SITL_WARP_PAGE, and jumps to it.
// A program that is not static, or a missing page, is executed as if this were not here.
#include "machine.h"

#include <elf.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#define PAGE 4096ul
#define DOWN(x) ((x) & ~(PAGE - 1))
#define UP(x) DOWN((x) + PAGE - 1)

extern HIDDEN const Elf64_Ehdr __ehdr_start;
extern HIDDEN const Elf64_Dyn _DYNAMIC[];

// Nobody has put this program's own pointers right for where the kernel loaded it: some compilers leave a few to do.
static void relocate_self(void) {
  uintptr_t base = (uintptr_t)&__ehdr_start, table = 0, size = 0;
  for (const Elf64_Dyn *d = _DYNAMIC; d->d_tag != DT_NULL; d++) {
    if (d->d_tag == DT_RELA) table = base + d->d_un.d_ptr;
    if (d->d_tag == DT_RELASZ) size = d->d_un.d_val;
  }
  for (const Elf64_Rela *r = (const Elf64_Rela *)table; table && (uintptr_t)r < table + size; r++)
    if (ELF64_R_TYPE(r->r_info) == MACHINE_RELATIVE) *(uintptr_t *)(base + r->r_offset) = base + (uintptr_t)r->r_addend;
}

static int starts_with(const char *s, const char *prefix) {
  while (*prefix)
    if (*s++ != *prefix++) return 0;
  return 1;
}

static void fail(const char *what) {
  size_t n = 0;
  while (what[n]) n++;
  CALL(SYS_write, 2, what, n);
  CALL(SYS_exit_group, 127);
}

static int failed(long result) { return result < 0 && result > -4096; }

// Maps one segment of the file at `base` + its address, with zeros behind the file's part.
static void map_segment(long fd, const Elf64_Phdr *p, uintptr_t base) {
  uintptr_t from = base + p->p_vaddr, file_end = from + p->p_filesz, end = from + p->p_memsz;
  int rights = (p->p_flags & PF_R ? PROT_READ : 0) | (p->p_flags & PF_W ? PROT_WRITE : 0) |
               (p->p_flags & PF_X ? PROT_EXEC : 0);
  if (p->p_filesz && failed(CALL(SYS_mmap, DOWN(from), UP(file_end) - DOWN(from), rights, MAP_PRIVATE | MAP_FIXED, fd,
                                 DOWN(p->p_offset))))
    fail("sitl: cannot map the static program\n");
  if (end > file_end && p->p_filesz && rights & PROT_WRITE)
    for (char *c = (char *)file_end; c < (char *)UP(file_end); c++) *c = 0;
  uintptr_t zeros = p->p_filesz ? UP(file_end) : DOWN(from);
  if (UP(end) > zeros &&
      failed(CALL(SYS_mmap, zeros, UP(end) - zeros, rights, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0)))
    fail("sitl: no memory for the static program\n");
}

// Reserves the addresses of all segments; returns what to add to those in the file. Never maps over anything.
static uintptr_t reserve(const Elf64_Ehdr *e, const Elf64_Phdr *ph) {
  uintptr_t low = UINTPTR_MAX, high = 0;
  for (int i = 0; i < e->e_phnum; i++)
    if (ph[i].p_type == PT_LOAD) {
      if (DOWN(ph[i].p_vaddr) < low) low = DOWN(ph[i].p_vaddr);
      if (UP(ph[i].p_vaddr + ph[i].p_memsz) > high) high = UP(ph[i].p_vaddr + ph[i].p_memsz);
    }
  int fixed = e->e_type == ET_EXEC;
  long at = CALL(SYS_mmap, fixed ? low : 0, high - low, PROT_NONE,
                 MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | (fixed ? MAP_FIXED_NOREPLACE : 0), -1, 0);
  if (failed(at) || (fixed && (uintptr_t)at != low)) fail("sitl: the static program's addresses are taken\n");
  return (uintptr_t)at - low;
}

static void set_auxiliary(Elf64_auxv_t *a, uintptr_t base, const Elf64_Ehdr *e, const Elf64_Phdr *ph, char *path) {
  uintptr_t headers = 0;
  for (int i = 0; i < e->e_phnum; i++)
    if (ph[i].p_type == PT_LOAD && ph[i].p_offset <= e->e_phoff && e->e_phoff < ph[i].p_offset + ph[i].p_filesz)
      headers = base + ph[i].p_vaddr + e->e_phoff - ph[i].p_offset;
  for (; a->a_type != AT_NULL; a++) switch (a->a_type) {
    case AT_PHDR: a->a_un.a_val = headers; break;
    case AT_PHNUM: a->a_un.a_val = e->e_phnum; break;
    case AT_PHENT: a->a_un.a_val = sizeof(Elf64_Phdr); break;
    case AT_ENTRY: a->a_un.a_val = base + e->e_entry; break;
    case AT_BASE: a->a_un.a_val = 0; break;
    case AT_EXECFN: a->a_un.a_val = (uintptr_t)path; break;
    case AT_SYSINFO_EHDR: a->a_un.a_val = (uintptr_t)warp_fake_vdso(); break;
    }
}

HIDDEN uintptr_t warp_start(uintptr_t *stack) {
  relocate_self();
  long argc = (long)stack[0];
  char **argv = (char **)(stack + 1), **envp = argv + argc + 1, **env = envp;
  if (argc < 3) fail("sitl: usage: sitl-static-runtime PROGRAM ARGV0 [ARGV1...]\n");
  const char *page_path = NULL;
  for (; *env; env++)
    if (starts_with(*env, "SITL_WARP_PAGE=")) page_path = *env + 15;
  static union {
    Elf64_Ehdr e;
    char bytes[PAGE];
  } head;
  char *path = argv[1];
  long fd = CALL(SYS_openat, AT_FDCWD, path, O_RDONLY | O_CLOEXEC, 0);
  if (failed(fd)) fail("sitl: cannot open the static program\n");
  long size = CALL(SYS_read, fd, head.bytes, sizeof head);
  const Elf64_Ehdr *e = &head.e;
  const Elf64_Phdr *ph = (const Elf64_Phdr *)(head.bytes + e->e_phoff);
  int is_static = size > (long)sizeof *e && *(const uint32_t *)e->e_ident == 0x464c457f && e->e_machine == MACHINE_ELF &&
                  e->e_phoff + (size_t)e->e_phnum * sizeof *ph <= (size_t)size;
  for (int i = 0; is_static && i < e->e_phnum; i++)
    if (ph[i].p_type == PT_INTERP) is_static = 0;
  if (!is_static || !page_path || !warp_attach(page_path)) {
    CALL(SYS_execve, path, argv + 2, envp);
    fail("sitl: cannot execute the program\n");
  }
  uintptr_t base = reserve(e, ph);
  for (int i = 0; i < e->e_phnum; i++)
    if (ph[i].p_type == PT_LOAD) map_segment(fd, &ph[i], base);
  CALL(SYS_close, fd);
  set_auxiliary((Elf64_auxv_t *)(env + 1), base, e, ph, path);
  const char *name = path;
  for (const char *c = path; *c; c++)
    if (*c == '/') name = c + 1;
  CALL(SYS_prctl, PR_SET_NAME, name); // what `ps` and `pkill` show
  if (!warp_take_over()) fail("sitl: the kernel refuses a system call filter (seccomp) for the static program\n");
  stack[2] = (uintptr_t)(argc - 2);
  return base + e->e_entry;
}
