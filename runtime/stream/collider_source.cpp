// SPDX-License-Identifier: Apache-2.0
#include "runtime/stream/collider_source.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "formats/container_reader.h"

namespace relief {
namespace {

class FileSource : public ColliderSource {
  public:
    FileSource(World world, std::filesystem::path folder, const ContainerLimits& limits)
        : world_(std::move(world)), folder_(std::move(folder)), limits_(limits), thread_([this] { run(); }) {}

    ~FileSource() override {
        {
            const std::lock_guard lock(mutex_);
            ends_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }

    void request(std::size_t collider) override {
        {
            const std::lock_guard lock(mutex_);
            requests_.push_back(collider);
            ++under_way_;
        }
        changed_.notify_all();
    }

    void release(Collider used) override {
        {
            const std::lock_guard lock(mutex_);
            released_.push_back(std::move(used));
        }
        changed_.notify_all();
    }

    std::optional<Arrival> take() override {
        const std::lock_guard lock(mutex_);
        return takeFirst();
    }

    std::optional<Arrival> wait() override {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !arrivals_.empty() || under_way_ == 0; });
        return takeFirst();
    }

  private:
    std::optional<Arrival> takeFirst() {
        if (arrivals_.empty()) {
            return std::nullopt;
        }
        std::optional<Arrival> first = std::move(arrivals_.front());
        arrivals_.pop_front();
        return first;
    }

    void run() {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [this] { return ends_ || !requests_.empty() || !released_.empty(); });
            if (ends_) {
                return;
            }
            if (!released_.empty()) {
                std::vector<Collider> used = std::exchange(released_, {});
                lock.unlock();
                used.clear();
                lock.lock();
                continue;
            }
            const std::size_t collider = requests_.front();
            requests_.pop_front();
            lock.unlock();
            Result<Collider> loaded = withinMemory([&]() -> Result<Collider> {
                return loadWorldCollider(world_, collider, WorldDetail::kFine, folder_, limits_);
            });
            lock.lock();
            arrivals_.push_back({collider, std::move(loaded)});
            --under_way_;
            changed_.notify_all();
        }
    }

    const World world_;
    const std::filesystem::path folder_;
    const ContainerLimits limits_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::size_t> requests_;
    std::deque<Arrival> arrivals_;
    std::vector<Collider> released_;
    std::size_t under_way_ = 0;
    bool ends_ = false;
    std::thread thread_;  // last, because it uses the other members
};

}  // namespace

Result<std::unique_ptr<ColliderSource>> makeFileSource(World world, std::filesystem::path folder,
                                                       const ContainerLimits& limits) {
    try {
        return std::make_unique<FileSource>(std::move(world), std::move(folder), limits);
    } catch (const std::system_error& error) {
        return fail(ErrorCode::kLimit,
                    std::string("cannot create a thread to load colliders: ") + error.what());
    }
}

}  // namespace relief
