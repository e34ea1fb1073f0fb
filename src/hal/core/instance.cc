// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/instance.hh"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <utility>

#include "hal/core/detail/context.hh"
#include "hal/core/detail/names.hh"
#include "hal/core/detail/segment.hh"

namespace mw::hal {

using namespace detail;

namespace {

// The default instance of the process, because the C API has no argument for the instance.
std::atomic<Instance *> process_instance{nullptr};

/// Instance names become file names.
Result<> check_instance(std::string_view instance) {
    const bool good = !instance.empty() && instance.size() <= 64 &&
                      std::all_of(instance.begin(), instance.end(), [](char c) {
                          return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                                 c == '-' || c == '_';
                      });
    if (!good) {
        return refuse(EINVAL,
                      fmt::format("instance name '{}': letters, digits, '-' and '_' are allowed, at most 64",
                                  instance));
    }
    return {};
}

}  // namespace

ThreadContext &detail::context() noexcept {
    thread_local ThreadContext thread_context;
    return thread_context;
}

Instance *current() noexcept {
    Instance *override = context().instance;
    return override != nullptr ? override : process_instance.load(std::memory_order_acquire);
}

void set_process_instance(Instance *hal) noexcept {
    process_instance.store(hal, std::memory_order_release);
}

UseInstance::UseInstance(Instance *hal) noexcept : before_(context().instance) {
    context().instance = hal;
}

UseInstance::~UseInstance() {
    context().instance = before_;
}

std::string default_instance() {
    const char *name = std::getenv("MILLWRIGHT_INSTANCE");
    return name != nullptr && name[0] != '\0' ? name : "default";
}

std::string segment_name(std::string_view instance) {
    return fmt::format("millwright-{}-{}.hal", ::getuid(), instance);
}

Instance::Instance(const InstanceOptions &options, std::unique_ptr<Segment> segment)
    : name_(options.name), segment_(std::move(segment)), scheduler_(options.scheduler),
      own_log_(options.log == nullptr ? std::make_unique<runtime::Log>() : nullptr),
      log_(options.log == nullptr ? own_log_.get() : options.log), host_status_(*segment_),
      memory_(*segment_), components_(*segment_, controller_watches_),
      processes_(*segment_, controller_watches_), pins_(*segment_), params_(*segment_), signals_(*segment_),
      values_(*segment_), functions_(*segment_), threads_(*this, *segment_, scheduler_),
      planners_(*this, *segment_, scheduler_) {}

Instance::~Instance() {
    if (isHost()) {
        threads_.remove_all();
        planners_.remove_all();
    }
    Instance *self = this;
    process_instance.compare_exchange_strong(self, nullptr);
}

Result<std::unique_ptr<Instance>> Instance::create(const InstanceOptions &options) {
    if (auto checked = check_instance(options.name); !checked) {
        return std::unexpected(checked.error());
    }
    if (options.scheduler == nullptr) {
        return refuse(EINVAL, "a HAL instance needs a scheduler");
    }
    auto memory = options.isShared
                      ? runtime::SharedMemory::create(segment_name(options.name), FIRST_SIZE, RESERVE, LAYOUT)
                      : runtime::SharedMemory::create_private(FIRST_SIZE, RESERVE, LAYOUT);
    if (!memory) {
        errno = ENOMEM;
        return std::unexpected(memory.error());
    }
    auto segment = std::make_unique<Segment>(std::move(*memory), options.isShared);
    segment->initialise(options.scheduler->isVirtual());
    segment->header().realtime = options.scheduler->isRealtime();
    return std::unique_ptr<Instance>(new Instance(options, std::move(segment)));
}

Result<std::unique_ptr<Instance>> Instance::attach(std::string_view name) {
    if (auto checked = check_instance(name); !checked) {
        return std::unexpected(checked.error());
    }
    auto memory = runtime::SharedMemory::attach(segment_name(name), LAYOUT);
    if (!memory) {
        return refuse(ENOENT, fmt::format("HAL instance '{}': {}", name, memory.error().message),
                      memory.error().hint.empty() ? "start it with halrun or realtime start"
                                                  : memory.error().hint);
    }
    if (!runtime::isAlive(memory->owner())) {
        return refuse(ENOENT, fmt::format("HAL instance '{}': its realtime process has ended", name));
    }
    InstanceOptions options;
    options.name = name;
    options.isShared = true;
    return std::unique_ptr<Instance>(
        new Instance(options, std::make_unique<Segment>(std::move(*memory), options.isShared)));
}

bool Instance::isVirtual() const noexcept {
    return segment_->header().is_virtual;
}

std::int64_t Instance::now_ns() const noexcept {
    if (scheduler_ != nullptr) {
        return scheduler_->now_ns();
    }
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

Result<> Instance::set_lock(std::uint8_t lock) {
    segment_->header().lock.store(lock);
    return {};
}

std::uint8_t Instance::lock() const noexcept {
    return segment_->header().lock.load();
}

}  // namespace mw::hal
