// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Counts allocations. Included by one file of a program, since it replaces operator new. Counts none under Clang's
// thread sanitizer, which replaces it too. Eigen's own are no `new`: tests define EIGEN_RUNTIME_NO_MALLOC, and forbid
// them.

#include <atomic>
#include <cstdlib>
#include <new>

namespace springfit::test {
inline std::atomic<long> n_allocations = 0;
}

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SPRINGFIT_TEST_KEEP_NEW
#endif
#endif

#ifndef SPRINGFIT_TEST_KEEP_NEW
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++springfit::test::n_allocations;
    if (void* memory = std::malloc(size)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
#endif
