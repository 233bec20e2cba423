#include "thread_stacks.hpp"

#include <pthread.h>

#include <cstddef>

namespace mmgrasp::python {
namespace {

constexpr std::size_t kLeastStack = std::size_t{8} << 20;  // as Linux gives unless told otherwise [bytes]

}  // namespace

void give_threads_room() {
  pthread_attr_t attributes;
  if (pthread_getattr_default_np(&attributes) != 0) return;
  std::size_t size = 0;
  pthread_attr_getstacksize(&attributes, &size);
  if (size < kLeastStack && pthread_attr_setstacksize(&attributes, kLeastStack) == 0)
    pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

}  // namespace mmgrasp::python
