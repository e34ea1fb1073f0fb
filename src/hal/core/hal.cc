// SPDX-License-Identifier: GPL-2.0-or-later
// Instances and components.
#include "hal/core/hal.hh"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/text.hh"
#include "hal/core/detail/impl.hh"

namespace mw::hal {
namespace detail {

std::unexpected<Error> refuse(int code, std::string message, std::string hint) {
    errno = code;
    return fail(std::move(message), {}, std::move(hint));
}

ThreadContext &context() noexcept {
    thread_local ThreadContext thread_context;
    return thread_context;
}

}  // namespace detail

using namespace detail;

std::string detail::segment_name(std::string_view instance) {
    return fmt::format("millwright-{}-{}.hal", ::getuid(), instance);
}

namespace {

// The C API has no argument for the instance, so a process needs a default one.
std::atomic<Hal *> process_instance{nullptr};

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

const char *kind_name(Kind kind) noexcept {
    switch (kind) {
    case Kind::COMP: return "component";
    case Kind::PIN: return "pin";
    case Kind::PARAM: return "parameter";
    case Kind::SIGNAL: return "signal";
    case Kind::FUNCT: return "function";
    case Kind::THREAD: return "thread";
    default: return "alias";
    }
}

}  // namespace

Hal *current() noexcept {
    Hal *override = context().instance;
    return override != nullptr ? override : process_instance.load(std::memory_order_acquire);
}

void set_process_instance(Hal *hal) noexcept {
    process_instance.store(hal, std::memory_order_release);
}

UseInstance::UseInstance(Hal *hal) noexcept : before_(context().instance) {
    context().instance = hal;
}

UseInstance::~UseInstance() {
    context().instance = before_;
}

std::string default_instance() {
    const char *name = std::getenv("MILLWRIGHT_INSTANCE");
    return name != nullptr && name[0] != '\0' ? name : "default";
}

Hal::Hal(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {
    impl_->self = this;
}

Hal::~Hal() {
    if (impl_->is_host) {
        Guard guard(*impl_);
        impl_->segment.header().running.store(0);
        impl_->segment.each<ThreadRecord>(Kind::THREAD,
                                          [&](ThreadRecord &thread) { (void)impl_->remove_thread(thread); });
        for (const auto &planner : impl_->planners) {
            impl_->scheduler->remove(planner->periodic);
        }
    }
    Hal *self = this;
    process_instance.compare_exchange_strong(self, nullptr);
}

Result<std::unique_ptr<Hal>> Hal::create(const HalOptions &options) {
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
    auto impl = std::make_unique<Impl>();
    impl->name = options.name;
    impl->is_host = true;
    impl->isShared = options.isShared;
    impl->scheduler = options.scheduler;
    impl->log = options.log;
    if (impl->log == nullptr) {
        impl->own_log = std::make_unique<runtime::Log>();
        impl->log = impl->own_log.get();
    }
    impl->segment = Segment(std::move(*memory));
    impl->segment.initialise(options.scheduler->isVirtual());
    impl->segment.header().realtime = options.scheduler->isRealtime();
    return std::unique_ptr<Hal>(new Hal(std::move(impl)));
}

Result<std::unique_ptr<Hal>> Hal::attach(std::string_view instance) {
    if (auto checked = check_instance(instance); !checked) {
        return std::unexpected(checked.error());
    }
    auto memory = runtime::SharedMemory::attach(segment_name(instance), LAYOUT);
    if (!memory) {
        return refuse(ENOENT, fmt::format("HAL instance '{}': {}", instance, memory.error().message),
                      memory.error().hint.empty() ? "start it with halrun or realtime start"
                                                  : memory.error().hint);
    }
    if (!runtime::isAlive(memory->owner())) {
        return refuse(ENOENT, fmt::format("HAL instance '{}': its realtime process is gone", instance));
    }
    auto impl = std::make_unique<Impl>();
    impl->name = instance;
    impl->isShared = true;
    impl->own_log = std::make_unique<runtime::Log>();
    impl->log = impl->own_log.get();
    impl->segment = Segment(std::move(*memory));
    return std::unique_ptr<Hal>(new Hal(std::move(impl)));
}

const std::string &Hal::name() const noexcept {
    return impl_->name;
}
bool Hal::isHost() const noexcept {
    return impl_->is_host;
}
bool Hal::isVirtual() const noexcept {
    return impl_->segment.header().is_virtual;
}
bool Hal::isRealtime() const noexcept {
    return impl_->segment.header().realtime;
}
std::string Hal::realtime_missing() const {
    Guard guard(*impl_);
    return impl_->segment.header().realtime_missing.data();
}
void Hal::set_realtime_missing(std::string_view why) {
    Guard guard(*impl_);
    auto &text = impl_->segment.header().realtime_missing;
    text.fill('\0');
    std::copy_n(why.begin(), std::min(why.size(), text.size() - 1), text.begin());
}
std::optional<std::string> Hal::host_end() const {
    const EndRecord &end = impl_->segment.header().end;
    if (end.state.load(std::memory_order_acquire) == EndRecord::WHOLE) {
        return end.text.data();
    }
    const bool gone = impl_->isShared && !runtime::isAlive(impl_->segment.memory().owner());
    return gone ? std::optional<std::string>("it was killed, or ended without a message") : std::nullopt;
}
runtime::Log &Hal::log() noexcept {
    return *impl_->log;
}
runtime::Scheduler *Hal::scheduler() noexcept {
    return impl_->scheduler;
}

std::int64_t Hal::now_ns() const noexcept {
    if (impl_->scheduler != nullptr) {
        return impl_->scheduler->now_ns();
    }
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

// ---- with the lock held

CompRecord *Hal::Impl::find_comp(int id) const noexcept {
    CompRecord *found = nullptr;
    segment.each<CompRecord>(Kind::COMP, [&](CompRecord &comp) {
        if (comp.id == id) {
            found = &comp;
        }
    });
    return found;
}

std::string Hal::Impl::comp_name(Offset comp) const {
    const auto *record = segment.at<CompRecord>(comp);
    return record == nullptr ? std::string() : std::string(record->name_view());
}

int Hal::Impl::comp_id(Offset comp) const noexcept {
    const auto *record = segment.at<CompRecord>(comp);
    return record == nullptr ? 0 : record->id;
}

Result<> Hal::Impl::check_name(Kind kind, std::string_view name_wanted) const {
    if (name_wanted.empty() || name_wanted.size() > NAME_LENGTH) {
        return refuse(EINVAL, fmt::format("{} name '{}' has {} characters, 1 to {} are allowed",
                                          kind_name(kind), name_wanted, name_wanted.size(), NAME_LENGTH));
    }
    const bool taken = segment.find(kind, name_wanted) != nullptr ||
                       (kind == Kind::PIN && segment.find(Kind::PIN_ALIAS, name_wanted) != nullptr) ||
                       (kind == Kind::PARAM && segment.find(Kind::PARAM_ALIAS, name_wanted) != nullptr);
    if (taken) {
        const bool alias = kind == Kind::PIN_ALIAS || kind == Kind::PARAM_ALIAS;
        return refuse(EEXIST, alias
                                  ? fmt::format("there is an alias '{}' already", name_wanted)
                                  : fmt::format("there is a {} '{}' already", kind_name(kind), name_wanted));
    }
    return {};
}

Result<> Hal::Impl::check_lock(std::uint8_t wanted, const char *what) const {
    if ((segment.header().lock.load(std::memory_order_relaxed) & wanted) != 0) {
        return refuse(EPERM, fmt::format("HAL is locked against {}", what),
                      "unlock it with the command 'unlock'");
    }
    return {};
}

std::unexpected<Error> Hal::Impl::no_such(Kind kind, std::string_view name_wanted) const {
    std::vector<std::string> names;
    segment.each<Record>(kind, [&](Record &record) { names.emplace_back(record.name_view()); });
    const std::string near = nearest_name(name_wanted, names);
    return refuse(ENOENT, fmt::format("there is no {} '{}'", kind_name(kind), name_wanted),
                  near.empty() ? std::string() : fmt::format("did you mean '{}'?", near));
}

Result<int> Hal::Impl::add_comp(std::string_view name_wanted, CompType type) {
    if (auto checked = check_name(Kind::COMP, name_wanted); !checked) {
        return std::unexpected(checked.error());
    }
    auto *comp = segment.make<CompRecord>(Kind::COMP, name_wanted);
    if (comp == nullptr) {
        return refuse(ENOMEM, fmt::format("component '{}': no HAL memory left", name_wanted));
    }
    comp->id = segment.header().next_comp_id;
    segment.header().next_comp_id += 3;
    comp->type = type;
    comp->process = runtime::this_process();
    comp->base = segment.base();
    segment.insert(Kind::COMP, *comp);
    // Writes of other processes and threads must not share a cache line with this one.
    segment.separate_values();
    return comp->id;
}

void Hal::Impl::remove_comp(CompRecord &comp, bool dead) noexcept {
    const Offset owner = segment.offset_of(&comp);
    if (dead) {
        note_death(comp);
    }
    segment.each<FunctRecord>(Kind::FUNCT, [&](FunctRecord &funct) {
        if (funct.comp == owner) {
            remove_funct(funct);
        }
    });
    segment.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        if (pin.comp == owner) {
            if (dead && pin.dir != Dir::IN) {
                write(value_of(pin), Value{pin.type, pin.has_safe_value ? pin.safe_value : 0});
            }
            remove_pin(pin);
        }
    });
    segment.each<ParamRecord>(Kind::PARAM, [&](ParamRecord &param) {
        if (param.comp == owner) {
            remove_param(param);
        }
    });
    std::erase_if(controller_watches, [&](const ControllerWatch &watch) { return watch.comp_id == comp.id; });
    segment.remove(Kind::COMP, comp);
}

// ---- components

Result<int> Hal::new_component(std::string_view name, CompType type) {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_LOAD, "new components"); !checked) {
        return std::unexpected(checked.error());
    }
    return impl_->add_comp(name, type);
}

Result<> Hal::set_ready(int comp_id, bool isReady) {
    Guard guard(*impl_);
    CompRecord *comp = impl_->find_comp(comp_id);
    if (comp == nullptr) {
        return refuse(EINVAL, fmt::format("there is no component with id {}", comp_id));
    }
    if (comp->isReady == isReady) {
        return refuse(EINVAL, fmt::format("component '{}' is {} already", comp->name_view(),
                                          isReady ? "ready" : "not ready"));
    }
    comp->isReady = isReady;
    // Release: threads acquire this word every cycle, so they see the complete component, whichever process
    // adds its functions.
    impl_->segment.header().running.fetch_or(0, std::memory_order_release);
    return {};
}

Result<> Hal::delete_component(int comp_id) {
    Guard guard(*impl_);
    CompRecord *comp = impl_->find_comp(comp_id);
    if (comp == nullptr) {
        return refuse(EINVAL, fmt::format("there is no component with id {}", comp_id));
    }
    impl_->remove_comp(*comp, false);
    impl_->constructors.erase(comp_id);
    return {};
}

Result<> Hal::set_insmod_args(int comp_id, std::string_view args) {
    Guard guard(*impl_);
    CompRecord *comp = impl_->find_comp(comp_id);
    if (comp == nullptr) {
        return refuse(EINVAL, fmt::format("there is no component with id {}", comp_id));
    }
    comp->is_loaded_by_loadrt = true;
    const Offset text = impl_->segment.allocate(args.size() + 1);
    if (text == 0) {
        return refuse(ENOMEM, "no HAL memory left");
    }
    std::memcpy(impl_->segment.at<char>(text), args.data(), args.size());
    comp->insmod_args = text;
    return {};
}

void *Hal::allocate(std::size_t bytes) {
    Guard guard(*impl_);
    return impl_->segment.at<void>(impl_->segment.allocate(bytes));
}

Result<> Hal::set_lock(std::uint8_t lock) {
    impl_->segment.header().lock.store(lock);
    return {};
}

std::uint8_t Hal::lock() const noexcept {
    return impl_->segment.header().lock.load();
}

Result<BlockRecord *> Hal::Impl::open_block(int key, std::size_t bytes) {
    const std::string block_name = std::to_string(key);
    auto *block = segment.find_as<BlockRecord>(Kind::BLOCK, block_name);
    const bool is_new = block == nullptr;
    if (is_new) {
        block = segment.make<BlockRecord>(Kind::BLOCK, block_name);
        if (block == nullptr) {
            return refuse(ENOMEM, fmt::format("shared block {}: no HAL memory left", key));
        }
        block->key = key;
    }
    if (bytes == 0 || (block->users > 0 && block->size < bytes)) {
        return refuse(EINVAL,
                      fmt::format("shared block {} has {} bytes, expected {}", key, block->size, bytes));
    }
    if (block->room < bytes) {
        const Offset memory = segment.allocate(bytes, 64);
        if (memory == 0) {
            return refuse(ENOMEM, fmt::format("shared block {}: no memory for {} bytes", key, bytes));
        }
        block->memory = memory;
        block->room = bytes;
    } else if (block->users == 0) {
        std::memset(segment.at<void>(block->memory), 0, bytes);
    }
    block->size = block->users == 0 ? bytes : block->size;
    ++block->users;
    if (is_new) {
        segment.insert(Kind::BLOCK, *block);
    }
    return block;
}

Result<void *> Hal::shared_block(int key, std::size_t bytes) {
    Guard guard(*impl_);
    auto block = impl_->open_block(key, bytes);
    if (!block) {
        return std::unexpected(block.error());
    }
    return impl_->segment.at<void>((*block)->memory);
}

}  // namespace mw::hal
