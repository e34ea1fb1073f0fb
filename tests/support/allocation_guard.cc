// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/support/allocation_guard.hh"

#include <cerrno>
#include <cstddef>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define MW_SANITIZER_HOOKS 1
#endif
#endif

namespace {

// One per thread, initialised without code, so that malloc may count from the first call on.
__thread std::uint64_t calls_of_thread = 0;

}  // namespace

extern "C" {

#ifdef MW_SANITIZER_HOOKS

// The sanitizers replace malloc, but call a hook for every call.
int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void *, std::size_t),
                                              void (*on_free)(const volatile void *));

static void count_malloc(const volatile void *, std::size_t) {
    ++calls_of_thread;
}
static void count_free(const volatile void *) {
    ++calls_of_thread;
}

#else

// The names of glibc's own functions for programs that replace them.
void *__libc_malloc(std::size_t size);
void *__libc_calloc(std::size_t count, std::size_t size);
void *__libc_realloc(void *memory, std::size_t size);
void *__libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void *memory);

void *malloc(std::size_t size) {
    ++calls_of_thread;
    return __libc_malloc(size);
}
void *calloc(std::size_t count, std::size_t size) {
    ++calls_of_thread;
    return __libc_calloc(count, size);
}
void *realloc(void *memory, std::size_t size) {
    ++calls_of_thread;
    return __libc_realloc(memory, size);
}
void *memalign(std::size_t alignment, std::size_t size) {
    ++calls_of_thread;
    return __libc_memalign(alignment, size);
}
void *aligned_alloc(std::size_t alignment, std::size_t size) {
    ++calls_of_thread;
    return __libc_memalign(alignment, size);
}
int posix_memalign(void **memory, std::size_t alignment, std::size_t size) {
    ++calls_of_thread;
    *memory = __libc_memalign(alignment, size);
    return *memory == nullptr ? ENOMEM : 0;
}
void free(void *memory) {
    ++calls_of_thread;
    __libc_free(memory);
}

#endif
}

namespace mw::testing {

AllocationGuard::AllocationGuard() noexcept {
#ifdef MW_SANITIZER_HOOKS
    static const int installed = __sanitizer_install_malloc_and_free_hooks(&count_malloc, &count_free);
    (void)installed;
#endif
    before_ = calls_of_thread;
}

AllocationGuard::~AllocationGuard() = default;

std::uint64_t AllocationGuard::calls() const noexcept {
    return calls_of_thread - before_;
}

}  // namespace mw::testing
