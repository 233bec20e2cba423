#include "core/worker_thread.hpp"

#include <sched.h>

#include <cerrno>
#include <cstdio>

#include <system_error>
#include <utility>

namespace mmgrasp::detail {
namespace {

/// Where the `number`-th of `all` workers begins: on a processor of its own where they take all that are usable, else
/// on any but this one. Empty: nothing can be said.
cpu_set_t begin_of(int number, int all, const cpu_set_t& usable) {
  cpu_set_t begin;
  CPU_ZERO(&begin);
  const int here = sched_getcpu(), count = CPU_COUNT(&usable);
  if (here < 0 || here >= CPU_SETSIZE || !CPU_ISSET(here, &usable)) return begin;
  if (all < count) {
    begin = usable;
    CPU_CLR(here, &begin);
    return begin;
  }
  int steps = number % count;
  int cpu = here;
  while (steps > 0) {
    cpu = (cpu + 1) % CPU_SETSIZE;
    if (CPU_ISSET(cpu, &usable)) --steps;
  }
  CPU_SET(cpu, &begin);
  return begin;
}

}  // namespace

bool processors_idle(int more) {
  // As "0.20 0.18 0.12 1/80 11206": the fourth field tells how many threads run.
  std::FILE* const file = std::fopen("/proc/loadavg", "re");
  if (file == nullptr) return false;
  int running = 0;
  const bool known = std::fscanf(file, "%*f %*f %*f %d/", &running) == 1;
  std::fclose(file);
  cpu_set_t usable;
  CPU_ZERO(&usable);
  return known && pthread_getaffinity_np(pthread_self(), sizeof usable, &usable) == 0 &&
         running + more <= CPU_COUNT(&usable);
}

WorkerThread::WorkerThread(int number, int all, bool beside, std::function<void()> work) : work_(std::move(work)) {
  CPU_ZERO(&usable_);
  int failed = EAGAIN;
  if (beside && pthread_getaffinity_np(pthread_self(), sizeof usable_, &usable_) == 0) {
    const cpu_set_t begin = begin_of(number, all, usable_);
    pthread_attr_t attributes;
    if (CPU_COUNT(&begin) > 0 && pthread_attr_init(&attributes) == 0) {
      placed_ = true;
      failed = pthread_attr_setaffinity_np(&attributes, sizeof begin, &begin);
      if (failed == 0) failed = pthread_create(&thread_, &attributes, run, this);
      pthread_attr_destroy(&attributes);
    }
  }
  if (failed != 0) {
    placed_ = false;
    failed = pthread_create(&thread_, nullptr, run, this);
  }
  if (failed != 0) throw std::system_error(failed, std::generic_category());
}

WorkerThread::~WorkerThread() {
  pthread_join(thread_, nullptr);
}

void* WorkerThread::run(void* self) {
  auto& worker = *static_cast<WorkerThread*>(self);
  if (worker.placed_) pthread_setaffinity_np(pthread_self(), sizeof worker.usable_, &worker.usable_);
  worker.work_();
  return nullptr;
}

}  // namespace mmgrasp::detail
