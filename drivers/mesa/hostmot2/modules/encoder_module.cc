// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/encoder.hh"
#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/small.hh"

namespace mw::mesa {

namespace {

enum EncoderRegister { COUNT, CONTROL, STAMP_DIVIDER, STAMP_COUNT, FILTER_RATE, TIMER };
constexpr std::uint8_t PROBE_VERSION = 0x80, FIRST_SKEW_VERSION = 4, VERSION_MASK = 0x7F;

struct BoardPins {
    std::uint32_t sample_frequency = 25'000'000, muxed_sample_frequency = 8'000'000;  ///< [Hz]
    double muxed_skew = 0.0;                                                          ///< [ns]
    bool hires_timestamp = false;
    std::int32_t timer_number = -1;
};
constexpr PinRow<BoardPins> PLAIN_PINS[] = {{"sample-frequency", Access::IN, &BoardPins::sample_frequency}};
constexpr PinRow<BoardPins> MUXED_PINS[] = {
    {"muxed-sample-frequency", Access::IN, &BoardPins::muxed_sample_frequency}};
constexpr PinRow<BoardPins> STAMP_PINS[] = {{"hires-timestamp", Access::IN, &BoardPins::hires_timestamp}};
constexpr PinRow<BoardPins> SKEW_PINS[] = {{"muxed-skew", Access::IN, &BoardPins::muxed_skew}};
constexpr PinRow<BoardPins> TIMER_PINS[] = {{"timer-number", Access::IN, &BoardPins::timer_number}};

constexpr std::uint32_t COARSE_STAMPS_HZ = 2'000'000, FINE_STAMPS_HZ = 10'000'000;

/// Registers hold n for clock / (n + 2).
std::uint32_t divider(std::uint32_t clock_hz, std::uint32_t frequency_hz, std::uint32_t most) noexcept {
    const std::uint32_t ratio = clock_hz / std::max(frequency_hz, 1U);
    return std::min(ratio < 2 ? 0U : ratio - 2, most);
}

std::uint32_t filter_word(const BoardPins &pins, bool muxed, std::uint32_t clock_hz) noexcept {
    constexpr std::uint32_t FULL_CLOCK = 0xFFF, MOST_DIVIDER = 0xFFE, MOST_SKEW = 0xF;
    constexpr unsigned SKEW_SHIFT = 28;
    const std::uint32_t frequency = muxed ? pins.muxed_sample_frequency : pins.sample_frequency;
    if (frequency >= clock_hz) {
        return FULL_CLOCK;
    }
    const double clocks = std::clamp(pins.muxed_skew * clock_hz * 1e-9, 0.0, double{MOST_SKEW});
    const std::uint32_t skew = muxed && clocks - clocks == 0.0 ? static_cast<std::uint32_t>(clocks) : 0U;
    return divider(clock_hz, frequency, MOST_DIVIDER) | (skew << SKEW_SHIFT);
}

class Encoders final : public Module {
  public:
    explicit Encoders(const ModuleRequest &request)
        : module_(request.module), instances_(static_cast<std::size_t>(request.module.instances)),
          muxed_(request.module.descriptor.gtag == Gtag::MUXED_ENCODER) {
        const std::uint8_t version = request.module.descriptor.version & VERSION_MASK;
        has_probe_ = (request.module.descriptor.version & PROBE_VERSION) != 0;
        has_skew_ = muxed_ && version >= FIRST_SKEW_VERSION;
        // The version number does not show whether the register exists; other firmware ignores the write.
        has_timer_ = hasDpll(request.assignment);
        // A firmware with both types numbers the muxed encoders after the plain ones, which use the pins of
        // the board.
        for (const UsedModule &other : request.assignment.modules) {
            first_ += muxed_ && other.descriptor.gtag == Gtag::ENCODER ? other.instances : 0;
        }
        has_timer_ = has_timer_ && first_ == 0;
    }

    bool isCounting() const noexcept override { return true; }
    void restart() noexcept override {
        for (Instance &one : instances_) {
            encoder_restart(one.state);
        }
    }
    void plan(Registers &registers) override {
        const auto count = static_cast<std::uint16_t>(instances_.size());
        stamp_ = registers.read({module_.address(STAMP_COUNT), 1}, ReadOrder::ENCODER_TIME);
        counts_ = registers.read({module_.address(COUNT), count}, ReadOrder::ENCODER_COUNT);
        controls_ = registers.read({module_.address(CONTROL), count}, ReadOrder::ENCODER_CONTROL);
        divider_ = registers.write(module_.address(STAMP_DIVIDER), WriteOrder::CONFIGURATION, Send::CHANGED);
        filter_ = registers.write(module_.address(FILTER_RATE), WriteOrder::CONFIGURATION, Send::CHANGED);
        if (has_timer_) {
            timer_ = registers.write(module_.address(TIMER), WriteOrder::CONFIGURATION, Send::CHANGED);
        }
        int number = 0;
        for (Instance &one : instances_) {
            one.control =
                registers.write(module_.address(CONTROL, number++), WriteOrder::RATE, Send::REQUESTED);
        }
    }
    void declare(PinSpace &space) override {
        int number = first_;
        for (Instance &one : instances_) {
            const std::string name = fmt::format("encoder.{:02}", number++);
            binding_.bind(space, name, ENCODER_PINS, one.pins);
            if (has_probe_) {
                binding_.bind(space, name, ENCODER_PROBE_PINS, one.pins);
            }
        }
        if (muxed_) {
            binding_.bind(space, "encoder", MUXED_PINS, board_);
        } else {
            binding_.bind(space, "encoder", PLAIN_PINS, board_);
        }
        if (first_ == 0) {
            binding_.bind(space, "encoder", STAMP_PINS, board_);
        }
        if (has_skew_) {
            binding_.bind(space, "encoder", SKEW_PINS, board_);
        }
        if (has_timer_) {
            binding_.bind(space, "encoder", TIMER_PINS, board_);
        }
    }
    void read(const Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        elapsed_s_ += cycle.period_s;
        EncoderReading reading;
        reading.time_now = registers.value(stamp_);
        reading.tick_s = stamp_tick_s();
        reading.elapsed_s = elapsed_s_;
        int number = 0;
        for (Instance &one : instances_) {
            reading.count = registers.value(counts_, number);
            reading.control = registers.value(controls_, number++);
            encoder_read(one.state, one.pins, reading);
        }
        elapsed_s_ = 0.0;
        binding_.store();
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        registers.set(divider_, stamp_divider());
        registers.set(filter_, filter_word(board_, muxed_, module_.clock_hz));
        if (has_timer_) {
            registers.set(timer_, dpll_timer_choice(board_.timer_number));
        }
        if (!cycle.fresh) {
            elapsed_s_ += cycle.period_s;  // read() was not called
            return;
        }
        for (Instance &one : instances_) {
            if (!cycle.writing) {
                continue;
            }
            if (const EncoderControl control = encoder_control(one.state, one.pins); control.isDue) {
                registers.request(one.control, control.value);
            }
        }
    }

  private:
    struct Instance {
        EncoderPins pins;
        EncoderState state;
        WriteHandle control;
    };
    std::uint32_t stamp_divider() const noexcept {
        constexpr std::uint32_t MOST = 0xFFFF;
        return divider(module_.clock_hz, board_.hires_timestamp ? FINE_STAMPS_HZ : COARSE_STAMPS_HZ, MOST);
    }
    double stamp_tick_s() const noexcept { return (stamp_divider() + 2.0) / module_.clock_hz; }

    UsedModule module_;
    std::vector<Instance> instances_;
    BoardPins board_;
    PinBinding binding_;
    ReadHandle stamp_, counts_, controls_;
    WriteHandle divider_, filter_, timer_;
    double elapsed_s_ = 0.0;
    int first_ = 0;
    bool muxed_, has_probe_ = false, has_skew_ = false, has_timer_ = false;
};

}  // namespace

std::unique_ptr<Module> make_encoders(const ModuleRequest &request) {
    return std::make_unique<Encoders>(request);
}

}  // namespace mw::mesa
