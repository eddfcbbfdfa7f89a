// SPDX-License-Identifier: AGPL-3.0-or-later
// Operator new for no_memory_test, which is C and cannot throw. The program exports it, so that libraries that are loaded later take it
// as well.
#include <cstddef>
#include <cstdlib>
#include <new>

/// NULL: there is no memory. `caller`: where operator new was called.
extern "C" void *new_block(std::size_t size, void *caller);

__attribute__((noinline)) void *operator new(std::size_t size)
{
    void *block = new_block(size, __builtin_return_address(0));
    if (!block)
        throw std::bad_alloc();
    return block;
}

__attribute__((noinline)) void *operator new[](std::size_t size)
{
    void *block = new_block(size, __builtin_return_address(0));
    if (!block)
        throw std::bad_alloc();
    return block;
}

void operator delete(void *block) noexcept { std::free(block); }
void operator delete(void *block, std::size_t) noexcept { std::free(block); }
void operator delete[](void *block) noexcept { std::free(block); }
void operator delete[](void *block, std::size_t) noexcept { std::free(block); }
