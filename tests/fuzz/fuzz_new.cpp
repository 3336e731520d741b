/* fuzz_new.cpp: C++'s memory for the target of pictures: what is too large throws, as it does without a sanitizer,
 * where ASan would end the process. Threads: any. */
#include <cstdlib>
#include <new>

namespace
{
const std::size_t most_bytes = std::size_t(96) << 20; /* as in fuzz.c */

void *take(std::size_t size)
{
    void *memory = size <= most_bytes ? std::malloc(size ? size : 1) : nullptr;
    if (!memory)
        throw std::bad_alloc();
    return memory;
}
} // namespace

#define EVERYWHERE __attribute__((visibility("default")))

EVERYWHERE void *operator new(std::size_t size) { return take(size); }
EVERYWHERE void *operator new[](std::size_t size) { return take(size); }
EVERYWHERE void *operator new(std::size_t size, const std::nothrow_t &) noexcept
{
    return size <= most_bytes ? std::malloc(size ? size : 1) : nullptr;
}
EVERYWHERE void operator delete(void *memory) noexcept { std::free(memory); }
EVERYWHERE void operator delete[](void *memory) noexcept { std::free(memory); }
EVERYWHERE void operator delete(void *memory, std::size_t) noexcept { std::free(memory); }
EVERYWHERE void operator delete[](void *memory, std::size_t) noexcept { std::free(memory); }
