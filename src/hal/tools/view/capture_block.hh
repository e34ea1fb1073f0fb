// SPDX-License-Identifier: GPL-2.0-or-later
// The shared block between the realtime module `capture` and its client. The client writes `settings` while
// nothing is recorded, then increases `request`; the module answers in its next cycle by setting `seen` to
// the same number, and from then on `state` refers to that request. Records are kept until the next request.
#pragma once

#include <atomic>
#include <cstdint>

namespace mw::hal::view {

/// Key of the block in rtapi_shmem.
inline constexpr int CAPTURE_KEY = 0x4d570300;
inline constexpr std::uint32_t CAPTURE_MAGIC = 0x4d576361;
inline constexpr int CAPTURE_CHANNELS = 16;

enum class CaptureState : std::uint32_t {
    IDLE,       ///< no request, or cancelled
    FILLING,    ///< recording the samples before the trigger
    WAITING,    ///< waiting for the trigger
    TRIGGERED,  ///< recording the samples after it
    DONE,       ///< `first` and `trigger_sample` are valid
    REFUSED     ///< the settings are not valid
};

enum class TriggerKind : std::uint32_t {
    NONE,     ///< immediately
    ABOVE,    ///< the value is above the level
    BELOW,    ///< the value is below the level
    RISING,   ///< the value rises above the level
    FALLING,  ///< the value falls below the level
    EITHER    ///< the value rises above or falls below the level
};

struct CaptureChannel {
    std::uint32_t type;  ///< hal_type_t
    std::int64_t
        offset;  ///< offset of the value from the start of the block [bytes]; both are in the HAL segment
};

struct CaptureSettings {
    std::uint32_t channels;  ///< 1 to CAPTURE_CHANNELS
    CaptureChannel channel[CAPTURE_CHANNELS];
    std::uint32_t samples;     ///< length of the record
    std::uint32_t pretrigger;  ///< samples before the trigger, below `samples`
    std::uint32_t every;  ///< record every N-th call, at least 1; triggers are checked in recorded calls only
    TriggerKind trigger;
    std::uint32_t trigger_channel;  ///< channel of the trigger; a channel used only for the trigger is
                                    ///< recorded, too
    double level;
};

struct CaptureBlock {
    std::uint32_t magic;
    std::uint32_t capacity;              ///< words in `data`
    std::atomic<std::int32_t> client;    ///< process that uses the block; 0: none
    CaptureSettings settings;            // written by the client before `request` is released
    std::atomic<std::uint32_t> request;  // released by the client, acquired by the module
    std::atomic<std::uint32_t> cancel;   // request to end without a record
    std::atomic<std::uint32_t> force;    // request to trigger now
    // Written by the module: `data`, `first`, `trigger_sample` are written before DONE is released.
    std::atomic<std::uint32_t> seen;
    std::atomic<CaptureState> state;
    std::atomic<std::uint32_t> recorded;  ///< samples so far, at most `samples`
    std::uint32_t first;                  ///< position of the oldest sample in the ring of `samples`
    std::uint32_t trigger_sample;         ///< index of the trigger's sample, the oldest is 0
    /// Samples: the time [ns], then a word for each channel as in HAL memory.
    alignas(64) std::uint64_t data[1];
};

/// Number of words of a record.
constexpr std::uint64_t capture_words(const CaptureSettings &settings) noexcept {
    return static_cast<std::uint64_t>(settings.samples) * (settings.channels + 1);
}

constexpr bool isSensible(const CaptureSettings &settings, std::uint32_t capacity) noexcept {
    return settings.channels >= 1 && settings.channels <= CAPTURE_CHANNELS && settings.samples >= 1 &&
           settings.pretrigger < settings.samples && settings.every >= 1 &&
           settings.trigger_channel < settings.channels && capture_words(settings) <= capacity;
}

}  // namespace mw::hal::view
