// SPDX-License-Identifier: BSD-3-Clause
// A stand-in for the kernel's shared object through which programs read the clock without a system call: the smallest
// ELF image that C libraries accept, with clock_gettime on the clock page.
#include "machine.h"
#include "runtime.h"

#include <elf.h>
#include <time.h>

#if defined(__x86_64__)
#define NAME "__vdso_clock_gettime"
#else
#define NAME "__kernel_clock_gettime"
#endif

static struct {
  Elf64_Ehdr header;
  Elf64_Phdr segments[2];
  Elf64_Dyn dynamic[6];
  Elf64_Sym symbols[2];
  uint32_t hash[6]; // one bucket, two symbols
  char names[32];
} image;

static int vdso_clock_gettime(clockid_t id, struct timespec *out) {
  if (runtime_is_warped(id)) return runtime_gettime(id, out);
  return (int)CALL(SYS_clock_gettime, id, out); // the caller takes any error but ENOSYS for its own
}

// Addresses inside the image count from its start, so the symbol may lie anywhere.
const void *warp_fake_vdso(void) {
  uintptr_t start = (uintptr_t)&image;
  image.header = (Elf64_Ehdr){.e_ident = {0x7f, 'E', 'L', 'F', ELFCLASS64, ELFDATA2LSB, EV_CURRENT},
                              .e_type = ET_DYN,
                              .e_machine = MACHINE_ELF,
                              .e_version = EV_CURRENT,
                              .e_phoff = (uintptr_t)image.segments - start,
                              .e_ehsize = sizeof(Elf64_Ehdr),
                              .e_phentsize = sizeof(Elf64_Phdr),
                              .e_phnum = 2};
  image.segments[0] = (Elf64_Phdr){.p_type = PT_LOAD, .p_flags = PF_R | PF_X, .p_filesz = sizeof image,
                                   .p_memsz = sizeof image, .p_align = 8};
  uintptr_t dynamic = (uintptr_t)image.dynamic - start;
  image.segments[1] = (Elf64_Phdr){.p_type = PT_DYNAMIC, .p_flags = PF_R, .p_offset = dynamic, .p_vaddr = dynamic,
                                   .p_filesz = sizeof image.dynamic, .p_memsz = sizeof image.dynamic, .p_align = 8};
  const char name[] = NAME;
  for (size_t i = 0; i < sizeof name; i++) image.names[i + 1] = name[i];
  image.symbols[1] = (Elf64_Sym){.st_name = 1, .st_info = ELF64_ST_INFO(STB_GLOBAL, STT_FUNC), .st_shndx = 1,
                                 .st_value = (uintptr_t)vdso_clock_gettime - start, .st_size = 64};
  image.hash[0] = 1, image.hash[1] = 2, image.hash[2] = 1;
  image.dynamic[0] = (Elf64_Dyn){DT_STRTAB, {(uintptr_t)image.names - start}};
  image.dynamic[1] = (Elf64_Dyn){DT_SYMTAB, {(uintptr_t)image.symbols - start}};
  image.dynamic[2] = (Elf64_Dyn){DT_HASH, {(uintptr_t)image.hash - start}};
  image.dynamic[3] = (Elf64_Dyn){DT_STRSZ, {sizeof image.names}};
  image.dynamic[4] = (Elf64_Dyn){DT_SYMENT, {sizeof(Elf64_Sym)}};
  return &image;
}
