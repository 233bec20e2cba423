#pragma once

#include <cstddef>
#include <functional>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"

namespace mmgrasp {

/// threads = 0 means all hardware threads.
MMGRASP_EXPORT int resolve_threads(int threads);

/// Runs work(item, worker) for item in [0, count), worker in [0, threads). Items are handed out dynamically, so results
/// must depend on the item alone (use Rng(seed, item)); one checker per worker. The calling thread takes part as worker
/// 0 and reports progress under `stage`. The first exception thrown by work is rethrown here. Returns false when
/// stopped early (some items then did not run).
MMGRASP_EXPORT bool parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, int)>& work,
                                 const Monitor& monitor = {}, const char* stage = "");

}  // namespace mmgrasp
