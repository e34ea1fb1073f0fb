// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/view/capture.hh"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/charts/chart.hh"
#include "base/text.hh"

namespace mw::hal::view {

namespace {

constexpr const char *FUNCTION = "capture.sample";

bool isAlive(int pid) {
    return pid != 0 && (::kill(pid, 0) == 0 || errno == EPERM);
}

/// Adds the function to a thread unless a thread already has it; returns the thread to which it was added.
Result<std::string> enter_thread(Instance &hal, const std::string &wanted) {
    const std::vector<ThreadInfo> threads = hal.threads().list();
    std::string chosen = wanted;
    for (const ThreadInfo &thread : threads) {
        if (std::find(thread.functions.begin(), thread.functions.end(), FUNCTION) != thread.functions.end()) {
            if (!wanted.empty() && wanted != thread.name) {
                return fail(fmt::format("{} runs in thread '{}' already", FUNCTION, thread.name), {},
                            "omit --thread, or remove the function with delf first");
            }
            return std::string{};
        }
        if (wanted.empty() && (threads.size() == 1 || thread.name == "servo-thread")) {
            chosen = thread.name;
        }
    }
    if (chosen.empty()) {
        return fail(threads.empty() ? "there is no thread to record in" : "there are several threads", {},
                    threads.empty() ? "loadrt threads, or start a machine" : "select a thread with --thread");
    }
    const Result<> added = hal.threads().add_function(FUNCTION, chosen);
    if (!added) {
        return std::unexpected(added.error());
    }
    return chosen;
}

double number_of(Type type, std::uint64_t bits) {
    Value value;
    value.type = type;
    value.bits = bits;
    return value.as_number();
}

}  // namespace

Result<Capture> Capture::open(Host &host, const std::string &thread) {
    const auto is_loaded = host.isModuleLoaded("capture");
    if (!is_loaded) {
        return std::unexpected(is_loaded.error());
    }
    if (!*is_loaded) {
        const Result<> loaded = host.load_realtime("capture", {});
        if (!loaded) {
            return std::unexpected(loaded.error());
        }
    }
    const auto memory = host.hal().memory().shared_block(CAPTURE_KEY, sizeof(CaptureBlock));
    if (!memory) {
        return std::unexpected(memory.error());
    }
    auto *block = static_cast<CaptureBlock *>(*memory);
    if (block->magic != CAPTURE_MAGIC) {
        return fail("the module capture is of another version", {},
                    "unload the module and load the module of this version");
    }
    std::int32_t client = block->client.load();
    if (client != ::getpid() && isAlive(client)) {
        return fail(fmt::format("process {} is recording already", client));
    }
    if (!block->client.compare_exchange_strong(client, ::getpid())) {
        return fail("another program is starting a recording");
    }
    Capture capture(host.hal(), *block);
    auto entered = enter_thread(host.hal(), thread);
    if (!entered) {
        return std::unexpected(entered.error());
    }
    capture.added_to_ = std::move(*entered);
    return capture;
}

Capture::Capture(Capture &&other) noexcept
    : hal_(other.hal_), block_(std::exchange(other.block_, nullptr)),
      added_to_(std::exchange(other.added_to_, {})), names_(std::move(other.names_)),
      settings_(other.settings_), request_(other.request_) {}

Capture::~Capture() {
    if (block_ == nullptr) {
        return;
    }
    cancel();
    if (!added_to_.empty()) {
        // If the thread no longer exists, neither does the function in it.
        (void)hal_->threads().remove_function(FUNCTION, added_to_);
    }
    block_->client.store(0);
}

Result<CaptureChannel> Capture::channel_of(const std::string &name) const {
    for (const auto &value : {hal_->values().get(name), hal_->signals().get(name)}) {
        if (!value) {
            continue;
        }
        const auto address = hal_->values().address_of(name, value->type);
        if (!address) {
            return std::unexpected(address.error());
        }
        const auto *place = static_cast<const volatile char *>(*address);
        return CaptureChannel{static_cast<std::uint32_t>(value->type),
                              place - reinterpret_cast<const volatile char *>(block_)};
    }
    std::vector<std::string> known;
    for (const PinInfo &pin : hal_->pins().list()) {
        known.push_back(pin.name);
    }
    for (const SignalInfo &signal : hal_->signals().list()) {
        known.push_back(signal.name);
    }
    const std::string near = nearest_name(name, known);
    return fail(fmt::format("there is no pin, signal or parameter '{}'", name), {},
                near.empty() ? "" : fmt::format("did you mean '{}'?", near));
}

Result<> Capture::begin(const CaptureRequest &request) {
    names_ = request.names;
    const bool has_trigger = request.trigger != TriggerKind::NONE;
    if (has_trigger && std::find(names_.begin(), names_.end(), request.trigger_name) == names_.end()) {
        names_.push_back(request.trigger_name);
    }
    if (names_.empty() || names_.size() > CAPTURE_CHANNELS) {
        return fail(
            fmt::format("{} channels requested, 1 to {} are possible", names_.size(), CAPTURE_CHANNELS));
    }
    if (!(request.pretrigger >= 0.0 && request.pretrigger < 1.0)) {
        return fail("the part before the trigger must be 0 to below 1 of the record");
    }
    settings_ = {};
    settings_.channels = static_cast<std::uint32_t>(names_.size());
    for (std::size_t i = 0; i < names_.size(); ++i) {
        const auto channel = channel_of(names_[i]);
        if (!channel) {
            return std::unexpected(channel.error());
        }
        settings_.channel[i] = *channel;
        if (has_trigger && names_[i] == request.trigger_name) {
            settings_.trigger_channel = static_cast<std::uint32_t>(i);
        }
    }
    settings_.samples = request.samples;
    settings_.every = request.every;
    settings_.trigger = request.trigger;
    settings_.level = request.level;
    settings_.pretrigger = static_cast<std::uint32_t>(std::floor(request.pretrigger * request.samples));
    if (request.samples < 1 || request.every < 1 || capture_words(settings_) > block_->capacity) {
        return fail(fmt::format("a record of {} channels has 1 to {} samples, of each 1st or later period",
                                names_.size(), block_->capacity / (names_.size() + 1)),
                    {}, "loadrt capture depth=WORDS gives more room");
    }
    block_->settings = settings_;
    request_ = block_->request.load() + 1;
    block_->request.store(request_, std::memory_order_release);
    return {};
}

CaptureState Capture::state() const noexcept {
    if (block_->seen.load(std::memory_order_acquire) != request_) {
        return CaptureState::FILLING;
    }
    return block_->state.load(std::memory_order_acquire);
}

void Capture::force() noexcept {
    block_->force.store(request_);
}

void Capture::cancel() noexcept {
    block_->cancel.store(request_);
}

Result<CaptureRecord> Capture::record() const {
    if (state() != CaptureState::DONE) {
        return fail("there is no complete record yet");
    }
    CaptureRecord record;
    record.names = names_;
    const std::size_t width = names_.size() + 1;
    record.columns.assign(names_.size(), std::vector<double>(settings_.samples));
    record.times_s.resize(settings_.samples);
    const auto sample = [&](std::uint32_t i) {
        return block_->data + static_cast<std::size_t>((block_->first + i) % settings_.samples) * width;
    };
    const std::uint64_t trigger_ns = sample(block_->trigger_sample)[0];
    for (std::uint32_t i = 0; i < settings_.samples; ++i) {
        const std::uint64_t *words = sample(i);
        record.times_s[i] = static_cast<double>(static_cast<std::int64_t>(words[0] - trigger_ns)) * 1e-9;
        for (std::size_t k = 0; k < names_.size(); ++k) {
            record.columns[k][i] = number_of(static_cast<Type>(settings_.channel[k].type), words[1 + k]);
        }
    }
    for (std::size_t k = 0; k < names_.size(); ++k) {
        record.types.push_back(static_cast<Type>(settings_.channel[k].type));
        const auto now = channel_of(names_[k]);
        if (!now || now->offset != settings_.channel[k].offset) {
            record.moved.push_back(names_[k]);
        }
    }
    return record;
}

std::string to_csv(const CaptureRecord &record) {
    std::string text = "time_s";
    for (const std::string &name : record.names) {
        text += "," + name;
    }
    text += "\n";
    for (std::size_t i = 0; i < record.times_s.size(); ++i) {
        text += fmt::format("{:.9f}", record.times_s[i]);
        for (const std::vector<double> &column : record.columns) {
            text += "," + to_text(column[i]);
        }
        text += "\n";
    }
    return text;
}

Result<> write_record(const CaptureRecord &record, const std::string &title, const std::string &path) {
    if (path.ends_with(".csv")) {
        return write_file_atomically(path, to_csv(record));
    }
    charts::StripChart chart{title, record.times_s, {}, 0.0};
    for (std::size_t k = 0; k < record.names.size(); ++k) {
        chart.curves.push_back({record.names[k], record.columns[k], record.types[k] == Type::BIT});
    }
    return charts::draw_strips(chart, path);
}

}  // namespace mw::hal::view
