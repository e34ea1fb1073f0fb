// SPDX-License-Identifier: GPL-2.0-or-later
// The work of the module capture in one cycle, without HAL.
#pragma once

#include "hal/tools/view/capture_block.hh"

namespace mw::components {

class CaptureCore {
  public:
    /// `read(channel)` returns the raw value in HAL memory; `number(channel, word)` converts it to a number.
    template <class Read, class Number>
    void step(hal::view::CaptureBlock &block, std::int64_t now_ns, Read read, Number number) noexcept {
        using hal::view::CaptureState;
        const std::uint32_t request = block.request.load(std::memory_order_acquire);
        if (request != block.seen.load(std::memory_order_relaxed)) {
            begin(block, request);
        }
        const CaptureState state = block.state.load(std::memory_order_relaxed);
        const bool busy = state == CaptureState::FILLING || state == CaptureState::WAITING ||
                          state == CaptureState::TRIGGERED;
        if (!busy) {
            return;
        }
        if (block.cancel.load(std::memory_order_relaxed) == request) {
            block.state.store(CaptureState::IDLE, std::memory_order_release);
            return;
        }
        if (++calls_ < settings_.every) {
            return;
        }
        calls_ = 0;
        const std::uint64_t *sample = record(block, now_ns, read);
        const std::uint32_t channel = settings_.trigger_channel;
        advance(block, request, number(channel, sample[1 + channel]));
    }

    const hal::view::CaptureSettings &settings() const noexcept { return settings_; }

  private:
    void begin(hal::view::CaptureBlock &block, std::uint32_t request) noexcept {
        using hal::view::CaptureState;
        settings_ = block.settings;
        position_ = 0;
        recorded_ = 0;
        calls_ = settings_.every - 1;  // the first sample is taken at once
        has_last_ = false;
        const bool good = isSensible(settings_, block.capacity);
        block.recorded.store(0, std::memory_order_relaxed);
        block.state.store(good ? CaptureState::FILLING : CaptureState::REFUSED, std::memory_order_relaxed);
        block.seen.store(request, std::memory_order_release);
    }

    template <class Read>
    const std::uint64_t *record(hal::view::CaptureBlock &block, std::int64_t now_ns, Read read) noexcept {
        std::uint64_t *sample = block.data + static_cast<std::uint64_t>(position_) * (settings_.channels + 1);
        sample[0] = static_cast<std::uint64_t>(now_ns);
        for (std::uint32_t i = 0; i < settings_.channels; ++i) {
            sample[1 + i] = read(i);
        }
        position_ = position_ + 1 == settings_.samples ? 0 : position_ + 1;
        recorded_ = recorded_ < settings_.samples ? recorded_ + 1 : recorded_;
        block.recorded.store(recorded_, std::memory_order_relaxed);
        return sample;
    }

    bool isTriggered(double value) noexcept {
        using hal::view::TriggerKind;
        const bool above = value > settings_.level, below = value < settings_.level;
        const bool risen = has_last_ && above && !(last_ > settings_.level);
        const bool fallen = has_last_ && below && !(last_ < settings_.level);
        last_ = value;
        has_last_ = true;
        switch (settings_.trigger) {
        case TriggerKind::NONE: return true;
        case TriggerKind::ABOVE: return above;
        case TriggerKind::BELOW: return below;
        case TriggerKind::RISING: return risen;
        case TriggerKind::FALLING: return fallen;
        case TriggerKind::EITHER: return risen || fallen;
        }
        return false;
    }

    /// Called after each sample: checks for the trigger and for the end of the record.
    void advance(hal::view::CaptureBlock &block, std::uint32_t request, double trigger_value) noexcept {
        using hal::view::CaptureState;
        CaptureState state = block.state.load(std::memory_order_relaxed);
        const bool has_trigger = isTriggered(trigger_value);
        if (state == CaptureState::FILLING && recorded_ > settings_.pretrigger) {
            state = CaptureState::WAITING;
        }
        if (state == CaptureState::WAITING &&
            (has_trigger || block.force.load(std::memory_order_relaxed) == request)) {
            state = CaptureState::TRIGGERED;
            remaining_ = settings_.samples - settings_.pretrigger - 1;
        } else if (state == CaptureState::TRIGGERED) {
            --remaining_;
        }
        if (state == CaptureState::TRIGGERED && remaining_ == 0) {
            // At least `samples` have been recorded, so the next position holds the oldest sample.
            block.first = position_;
            block.trigger_sample = settings_.pretrigger;
            state = CaptureState::DONE;
        }
        block.state.store(state, std::memory_order_release);
    }

    hal::view::CaptureSettings settings_{};
    std::uint32_t position_ = 0;   ///< position of the next sample
    std::uint32_t recorded_ = 0;   ///< number of samples in the ring
    std::uint32_t calls_ = 0;      ///< calls since the last sample
    std::uint32_t remaining_ = 0;  ///< number of samples still to record after the trigger
    double last_ = 0.0;
    bool has_last_ = false;
};

}  // namespace mw::components
