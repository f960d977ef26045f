// SPDX-License-Identifier: Apache-2.0
// Runs long work so that Ctrl-C in Python interrupts it, although the work itself does not use Python.
#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "formats/base/result.h"
#include "formats/base/text.h"

namespace relief {

/// Calls f() without the GIL.
template <class F>
auto released(const F& f) {
    const pybind11::gil_scoped_release release;
    return f();
}

/// Throws the exception of a Python signal handler, such as KeyboardInterrupt. Requires the GIL.
inline void raiseSignals() {
    if (PyErr_CheckSignals() != 0) {
        throw pybind11::error_already_set();
    }
}

/// Interval of signal checks.
inline constexpr std::chrono::milliseconds kSignalInterval{50};

/// Thrown by checkpoints in abandoned work.
struct Abandoned {};

/// Held by work that may be abandoned. If the process exits while such work runs, static destructors of libraries are
/// skipped, because the work still uses their objects.
class MayBeAbandoned {
  public:
    MayBeAbandoned() {
        // Runs before the destructors of libraries: handlers run in reverse order of registration.
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

/// Runs work(checkpoint) on its own thread, without the GIL, while this thread checks for signals. If a Python signal
/// handler raises an exception, as on Ctrl-C, this function throws it at once. The work then ends at its next
/// checkpoint.
/// \param work     returns a Result<T>; owns everything it uses, and does not use Python.
/// \param seconds  time limit; none: unlimited.
/// Errors: those of the work; kLimit (time limit exceeded); kFailure (no thread). Exceptions of the work and of signal
/// handlers propagate.
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
            return fail(ErrorCode::kLimit,
                        "the bake did not finish within " + shortest(*seconds) +
                            " s; simplify the mesh, lower the budget or resolution, or raise --timeout");
        }
    }
    if (state->thrown) {
        std::rethrow_exception(state->thrown);
    }
    return std::move(*state->result);
}

}  // namespace relief
