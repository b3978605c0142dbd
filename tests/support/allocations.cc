#include "support/allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<long> taken = 0;
}

// The linker gives calls of malloc() and aligned_alloc() to these (-Wl,--wrap).
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_aligned_alloc(std::size_t align, std::size_t size);
void* __wrap_malloc(std::size_t size) {
  ++taken;
  return __real_malloc(size);
}
void* __wrap_aligned_alloc(std::size_t align, std::size_t size) {
  ++taken;
  return __real_aligned_alloc(align, size);
}
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* place = std::malloc(size)) return place;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return std::malloc(size);
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t align) {
  if (void* place = std::aligned_alloc(static_cast<std::size_t>(align), size)) return place;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* place) noexcept {
  std::free(place);
}
[[gnu::noinline]] void operator delete(void* place, std::size_t) noexcept {
  std::free(place);
}
[[gnu::noinline]] void operator delete(void* place, std::align_val_t) noexcept {
  std::free(place);
}
[[gnu::noinline]] void operator delete(void* place, std::size_t, std::align_val_t) noexcept {
  std::free(place);
}

namespace support {

long allocations() {
  return taken;
}

}  // namespace support
