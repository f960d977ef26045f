// SPDX-License-Identifier: Apache-2.0
// Long work that Ctrl-C ends, though the work knows nothing of Python.
#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "formats/base/result.h"
#include "formats/base/text.h"

namespace relief {

/// f() without the GIL.
template <class F>
auto released(const F& f) {
    const pybind11::gil_scoped_release release;
    return f();
}

/// Throws what a signal handler of Python raised: KeyboardInterrupt. With the GIL.
inline void raiseSignals() {
    if (PyErr_CheckSignals() != 0) {
        throw pybind11::error_already_set();
    }
}

/// Between two looks at signals.
inline constexpr std::chrono::milliseconds kSignalInterval{50};

/// Thrown by checkpoints in abandoned work.
struct Abandoned {};

/// Held by work that may be abandoned. A process that exits meanwhile ends at once: the work still uses what the
/// destructors of libraries would take down.
class MayBeAbandoned {
  public:
    MayBeAbandoned() {
        // Called before the destructors of libraries, whose registration is older.
        static const int registered = ::on_exit(endAtOnce, nullptr);
        static_cast<void>(registered);
        ++running;
    }
    ~MayBeAbandoned() { --running; }
    MayBeAbandoned(const MayBeAbandoned&) = delete;
    MayBeAbandoned& operator=(const MayBeAbandoned&) = delete;

  private:
    static void endAtOnce(int status, void* /*nothing*/) {
        if (running > 0) {
            std::fflush(nullptr);
            ::_exit(status);
        }
    }
    static inline std::atomic<int> running = 0;
};

/// work(checkpoint) on a thread of its own, without the GIL, while this one looks at signals: a handler of Python that
/// raises, as Ctrl-C does, is obeyed at once. The work then goes on as far as its next checkpoint, where it ends.
/// \param work     returns a Result<T>; owns all that it uses, and touches nothing of Python.
/// \param seconds  that it may take; none: any.
/// Errors: those of the work; kLimit: the time is up; kFailure: there is no thread. What the work throws, and what signal
/// handlers raise, is thrown.
template <class T, class Work>
Result<T> interruptible(Work work, std::optional<float> seconds = {}) {
    struct State {
        explicit State(Work given) : work(std::move(given)) {}
        Work work;
        std::atomic<bool> abandoned = false;
        std::mutex mutex;
        std::condition_variable ended;
        bool done = false;
        std::optional<Result<T>> result;
        std::exception_ptr thrown;
    };
    const auto state = std::make_shared<State>(std::move(work));
    try {
        std::thread([state, running = std::make_unique<MayBeAbandoned>()] {
            try {
                state->result.emplace(state->work([&abandoned = state->abandoned] {
                    if (abandoned) {
                        throw Abandoned{};
                    }
                }));
            } catch (...) {
                state->thrown = std::current_exception();
            }
            const std::lock_guard lock(state->mutex);
            state->done = true;
            state->ended.notify_all();
        }).detach();
    } catch (const std::system_error& error) {
        return fail(ErrorCode::kFailure, "no thread could be started (" + error.code().message() +
                                             "); end processes or raise their limit (ulimit -u)");
    }
    const auto begun = std::chrono::steady_clock::now();
    for (bool done = false; !done;) {
        done = released([&] {
            std::unique_lock lock(state->mutex);
            return state->ended.wait_for(lock, kSignalInterval, [&] { return state->done; });
        });
        const std::chrono::duration<float> passed = std::chrono::steady_clock::now() - begun;
        const bool late = !done && seconds && passed.count() > *seconds;
        state->abandoned = late;
        if (PyErr_CheckSignals() != 0) {
            state->abandoned = true;
            throw pybind11::error_already_set();
        }
        if (late) {
            return fail(ErrorCode::kLimit, "the bake did not end within " + shortest(*seconds) +
                                               " s; simplify the mesh, ask for less, or raise --time-limit");
        }
    }
    if (state->thrown) {
        std::rethrow_exception(state->thrown);
    }
    return std::move(*state->result);
}

}  // namespace relief
