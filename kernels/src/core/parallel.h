// SPDX-License-Identifier: GPL-3.0-or-later
// Work shared among threads: tasks are numbered, each writes only what is its own, so results do not depend on who
// does which.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace opal {

inline int resolve_threads(int wanted) { return wanted > 0 ? wanted : std::max(1, int(std::thread::hardware_concurrency())); }

// Runs task(i) for i in [0, n) on `threads` threads (the caller is one of them). Stops handing out tasks when `cancel`
// becomes true or a task throws; the first exception is thrown again here. Returns whether every task was run.
template <class Task>
bool parallel_for(int64_t n, int threads, const std::atomic<bool> &cancel, const Task &task) {
  std::atomic<int64_t> next{0}, done{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  std::atomic<bool> failed{false};
  const auto work = [&] {
    try {
      for (;;) {
        if (cancel.load(std::memory_order_relaxed) || failed.load(std::memory_order_relaxed)) return;
        const int64_t i = next.fetch_add(1, std::memory_order_relaxed);
        if (i >= n) return;
        task(i);
        done.fetch_add(1, std::memory_order_relaxed);
      }
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  };
  std::vector<std::thread> crew;
  const int helpers = int(std::min<int64_t>(threads, n)) - 1;
  try {
    for (int i = 0; i < helpers; ++i) crew.emplace_back(work);
  } catch (const std::system_error &) {  // fewer threads than hoped for
  }
  work();
  for (std::thread &t : crew) t.join();
  if (failure) std::rethrow_exception(failure);
  return done.load() == n;
}

}  // namespace opal
