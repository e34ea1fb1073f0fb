/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Preloaded into a driver, it answers instead of hardware: a parallel port in EPP mode (I/O instructions of
 * x86-64) and /dev/spidev. Behind both are 64 KiB of registers, read from the file $BUS_SHIM_REGISTERS. Each
 * access is a line in $BUS_SHIM_LOG. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/spi/spidev.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <ucontext.h>
#include <unistd.h>

enum { BASE = 0x378, STATUS = 1, EPP_ADDRESS = 3, EPP_DATA = 4, REGISTER_BYTES = 0x10000 };

static uint8_t registers[REGISTER_BYTES];
static FILE *log_file;
static uint16_t epp_address;
static int is_high_byte;
static int spi_file = -1;

__attribute__((constructor)) static void begin(void);

/* ---- parallel port */

static uint8_t *next_byte(void) {
    uint8_t *byte = &registers[epp_address & 0x7FFF];
    is_high_byte = 0;
    if ((epp_address & 0x8000) != 0) {
        epp_address = 0x8000 | ((epp_address + 1) & 0x7FFF);
    }
    return byte;
}

static uint32_t read_port(uint16_t port, int bytes) {
    const int offset = port - BASE;
    uint32_t value = offset == STATUS ? 0x86 : 0;
    for (int i = 0; offset == EPP_DATA && i < bytes; ++i) {
        value |= (uint32_t)*next_byte() << (8 * i);
    }
    fprintf(log_file, "in%d %x\n", 8 * bytes, port);
    return value;
}

static void write_port(uint16_t port, uint32_t value, int bytes) {
    const int offset = port - BASE;
    fprintf(log_file, "out%d %x %x\n", 8 * bytes, port, value);
    if (offset == EPP_ADDRESS) {
        epp_address = is_high_byte ? (epp_address & 0xFF) | (value << 8) : value;
        is_high_byte = !is_high_byte;
    }
    for (int i = 0; offset == EPP_DATA && i < bytes; ++i) {
        *next_byte() = (uint8_t)(value >> (8 * i));
    }
}

/* An I/O instruction of a process without the permission for it. */
static void on_fault(int signal_number, siginfo_t *info, void *context) {
    (void)info;
    greg_t *const machine = ((ucontext_t *)context)->uc_mcontext.gregs;
    const uint8_t *at = (const uint8_t *)machine[REG_RIP];
    const int is_short = *at == 0x66;
    const uint8_t code = at[is_short];
    const int bytes = (code & 1) == 0 ? 1 : is_short ? 2 : 4;
    const uint64_t mask = bytes == 4 ? 0xFFFFFFFF : (1U << (8 * bytes)) - 1;
    const uint16_t port = (uint16_t)machine[REG_RDX];
    if (code == 0xEC || code == 0xED) {
        const uint64_t kept = bytes == 4 ? 0 : (uint64_t)machine[REG_RAX] & ~mask;
        machine[REG_RAX] = (greg_t)(kept | (read_port(port, bytes) & mask));
    } else if (code == 0xEE || code == 0xEF) {
        write_port(port, (uint32_t)((uint64_t)machine[REG_RAX] & mask), bytes);
    } else {
        signal(signal_number, SIG_DFL);
        return;
    }
    machine[REG_RIP] += is_short + 1;
}

int ioperm(unsigned long from, unsigned long count, int on) {
    (void)from, (void)count, (void)on;
    return 0;
}

/* The handler above remains installed. */
int sigaction(int number, const struct sigaction *action, struct sigaction *old) {
    int (*real)(int, const struct sigaction *, struct sigaction *) = dlsym(RTLD_NEXT, "sigaction");
    const int is_ours = action != NULL && action->sa_sigaction == on_fault;
    return number == SIGSEGV && action != NULL && !is_ours ? 0 : real(number, action, old);
}

static void begin(void) {
    const char *image = getenv("BUS_SHIM_REGISTERS"), *log = getenv("BUS_SHIM_LOG");
    FILE *file = image == NULL ? NULL : fopen(image, "rb");
    if (file == NULL || fread(registers, 1, REGISTER_BYTES, file) != REGISTER_BYTES || log == NULL) {
        fprintf(stderr, "bus_shim: BUS_SHIM_REGISTERS and BUS_SHIM_LOG must name files\n");
        exit(1);
    }
    fclose(file);
    log_file = fopen(log, "ae");
    setvbuf(log_file, NULL, _IOLBF, 0);
    struct sigaction action = {.sa_sigaction = on_fault, .sa_flags = SA_SIGINFO | SA_NODEFER};
    sigaction(SIGSEGV, &action, NULL);
}

/* ---- SPI */

static void exchange(uint32_t *words, unsigned count) {
    for (unsigned i = 0; i < count;) {
        const uint32_t command = words[i];
        uint32_t address = command >> 16;
        words[i] = 0;
        ++i;
        for (unsigned left = (command >> 4) & 0x7F; left > 0 && i < count; --left, ++i) {
            uint32_t *const word = (uint32_t *)(void *)&registers[address & 0xFFFC];
            if (((command >> 12) & 0xF) == 0xB) {
                *word = words[i];
                words[i] = 0;
            } else {
                words[i] = *word;
            }
            address += (command & 0x800) != 0 ? 4 : 0;
        }
    }
}

static int transfer(const struct spi_ioc_transfer *one) {
    uint32_t *sent = (uint32_t *)(uintptr_t)one->tx_buf, *received = (uint32_t *)(uintptr_t)one->rx_buf;
    uint32_t words[2048];
    if (sent == NULL || one->len > sizeof words) {
        return -1;
    }
    memcpy(words, sent, one->len);
    fprintf(log_file, "spi %u:", one->speed_hz);
    for (unsigned i = 0; i < one->len / 4; ++i) {
        fprintf(log_file, " %08x", words[i]);
    }
    fprintf(log_file, "\n");
    exchange(words, one->len / 4);
    if (received != NULL) {
        memcpy(received, words, one->len);
    }
    return (int)one->len;
}

int open(const char *path, int flags, ...) {
    int (*real)(const char *, int, ...) = dlsym(RTLD_NEXT, "open");
    va_list more;
    va_start(more, flags);
    const int mode = va_arg(more, int);
    va_end(more);
    if (strncmp(path, "/dev/spidev", strlen("/dev/spidev")) != 0) {
        return real(path, flags, mode);
    }
    spi_file = real("/dev/null", O_RDWR | O_CLOEXEC);
    return spi_file;
}

int ioctl(int file, unsigned long request, ...) {
    int (*real)(int, unsigned long, void *) = dlsym(RTLD_NEXT, "ioctl");
    va_list more;
    va_start(more, request);
    void *argument = va_arg(more, void *);
    va_end(more);
    if (file != spi_file || spi_file < 0) {
        return real(file, request, argument);
    }
    return _IOC_NR(request) == 0 ? transfer(argument) : 0;
}
