#pragma once

namespace mmgrasp::python {

/// Stacks of threads that are started from here on hold our calls also where the process has little (ulimit -s).
void give_threads_room();

}  // namespace mmgrasp::python
