// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/small.hh"
#include "drivers/mesa/hostmot2/modules/stepgen.hh"

namespace mw::mesa {

namespace {

enum StepgenRegister {
    RATE,
    ACCUMULATOR,
    MODE,
    DIRECTION_SETUP,
    DIRECTION_HOLD,
    PULSE_WIDTH,
    PULSE_SPACE,
    TABLE_DATA,
    TABLE_LENGTH,
    MASTER_RATE,
    TIMER,
};
constexpr std::uint32_t FULL_RATE = 0xFFFFFFFF;
constexpr std::uint8_t SWAP_VERSION = 0x40, LATCH_VERSION = 0x80, FIRST_TIMER_VERSION = 2,
                       VERSION_MASK = 0x3F;
constexpr std::uint8_t FIRST_TABLE_PIN = 0x83, LAST_TABLE_PIN = 0x88;

bool hasTablePins(const Idrom &idrom) {
    return std::ranges::any_of(idrom.pins, [](const PinDescriptor &pin) {
        return pin.secondary == Gtag::STEPGEN && pin.secondary_pin >= FIRST_TABLE_PIN &&
               pin.secondary_pin <= LAST_TABLE_PIN;
    });
}

struct TimerPin {
    std::int32_t timer_number = -1;
};
constexpr PinRow<TimerPin> TIMER_PINS[] = {{"timer-number", Access::IN, &TimerPin::timer_number}};

class Stepgens final : public Module {
  public:
    explicit Stepgens(const ModuleRequest &request)
        : module_(request.module), instances_(static_cast<std::size_t>(request.module.instances)),
          has_timer_(hasDpll(request.assignment) &&
                     (request.module.descriptor.version & VERSION_MASK) >= FIRST_TIMER_VERSION),
          has_latch_((request.module.descriptor.version & LATCH_VERSION) != 0),
          has_tables_(hasTablePins(request.idrom)) {
        const std::uint32_t longest = longest_step_time(module_.clock_hz);
        for (Instance &one : instances_) {
            one.pins.steplen = one.pins.stepspace = longest;
            one.pins.dirsetup = one.pins.dirhold = longest;
        }
    }

    bool isCounting() const noexcept override { return true; }
    bool isMovingUnmeasured() const noexcept override {
        return std::ranges::any_of(instances_, [](const Instance &one) { return one.pins.enable; });
    }
    void restart() noexcept override {
        for (Instance &one : instances_) {
            stepgen_restart(one.state);
        }
    }
    void plan(Registers &registers) override {
        accumulators_ =
            registers.read({module_.address(ACCUMULATOR), static_cast<std::uint16_t>(instances_.size())},
                           ReadOrder::STEP_ACCUMULATOR);
        if (has_latch_) {
            modes_ = registers.read({module_.address(MODE), static_cast<std::uint16_t>(instances_.size())},
                                    ReadOrder::STEP_ACCUMULATOR);
        }
        registers.write(module_.address(MASTER_RATE), WriteOrder::CONFIGURATION, Send::AFTER_FAULT,
                        FULL_RATE);
        if (has_timer_) {
            timer_ = registers.write(module_.address(TIMER), WriteOrder::CONFIGURATION, Send::CHANGED);
        }
        int number = 0;
        for (Instance &one : instances_) {
            const auto add = [&](int reg) {
                return registers.write(module_.address(reg, number), WriteOrder::CONFIGURATION,
                                       Send::CHANGED);
            };
            one.mode = registers.write(module_.address(MODE, number), WriteOrder::CONFIGURATION,
                                       has_latch_ ? Send::REQUESTED : Send::CHANGED);
            if (has_tables_) {
                one.length = add(TABLE_LENGTH);
                for (WriteHandle &step : one.steps) {
                    step = registers.write(module_.address(TABLE_DATA, number), WriteOrder::CONFIGURATION,
                                           Send::REPEATED);
                }
            }
            one.setup = add(DIRECTION_SETUP);
            one.hold = add(DIRECTION_HOLD);
            one.width = add(PULSE_WIDTH);
            one.space = add(PULSE_SPACE);
            one.rate = registers.write(module_.address(RATE, number), WriteOrder::RATE, Send::ALWAYS);
            ++number;
        }
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            const std::string name = fmt::format("stepgen.{:02}", number++);
            binding_.bind(space, name, STEPGEN_PINS, one.pins);
            if ((module_.descriptor.version & SWAP_VERSION) != 0) {
                binding_.bind(space, name, STEPGEN_SWAP_PINS, one.pins);
            }
            if (has_latch_) {
                binding_.bind(space, name, STEPGEN_LATCH_PINS, one.pins);
            }
            // LinuxCNC creates these pins with every firmware; without table pins they have no effect.
            binding_.bind(space, name, STEPGEN_TABLE_PINS, one.table_pins);
        }
        if (has_timer_) {
            binding_.bind(space, "stepgen", TIMER_PINS, timer_pins_);
        }
    }
    void read(const Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        int number = 0;
        for (Instance &one : instances_) {
            stepgen_read(one.state, one.pins, registers.value(accumulators_, number));
            if (has_latch_) {
                stepgen_take_latch(one.latch, one.state, one.pins,
                                   {registers.value(modes_, number), cycle.has_lost_write});
            }
            ++number;
        }
        binding_.store();
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        const std::uint32_t clock = module_.clock_hz;
        for (Instance &one : instances_) {
            const std::int32_t rate = stepgen_rate(one.state, one.pins, cycle.period_s, cycle.fresh, clock);
            registers.set(one.rate, static_cast<std::uint32_t>(rate));
            write_mode(registers, cycle, one);
            write_table(registers, cycle, one);
            registers.set(one.setup, step_clocks(one.pins.dirsetup, clock));
            registers.set(one.hold, step_clocks(one.pins.dirhold, clock));
            registers.set(one.width, step_clocks(one.pins.steplen, clock));
            registers.set(one.space, step_clocks(one.pins.stepspace, clock));
        }
        if (has_timer_) {
            registers.set(timer_, dpll_timer_choice(timer_pins_.timer_number));
        }
        binding_.store();
    }

  private:
    struct Instance {
        StepgenPins pins;
        StepgenState state;
        StepgenLatch latch;
        StepTablePins table_pins;
        StepTable table;  ///< table as sent
        WriteHandle rate, mode, setup, hold, width, space, length;
        std::array<WriteHandle, MAX_TABLE_STEPS> steps;
    };

    void write_mode(Registers &registers, const Cycle &cycle, Instance &one) const noexcept {
        if (!has_latch_) {
            registers.set(one.mode, stepgen_mode(one.pins));
        } else if (cycle.fresh && cycle.writing) {
            if (const StepgenModeWrite mode = stepgen_latch_mode(one.latch, one.pins); mode.isDue) {
                registers.request(one.mode, mode.value);
            }
        }
    }
    /// The board expects the steps of a table from the last to the first, always all of them.
    void write_table(Registers &registers, const Cycle &cycle, Instance &one) const noexcept {
        const StepTable table = step_table(one.pins.step_type, one.table_pins);
        if (!has_tables_ || !cycle.writing || table == one.table) {
            return;
        }
        one.table = table;
        registers.set(one.length, table.length == 0 ? 0U : table.length - 1);
        for (const WriteHandle step : one.steps) {
            registers.forget(step);
        }
        for (std::size_t i = 0; i < table.length; ++i) {
            registers.request(one.steps[one.steps.size() - 1 - i], table.steps[i]);
        }
    }

    UsedModule module_;
    std::vector<Instance> instances_;
    TimerPin timer_pins_;
    PinBinding binding_;
    ReadHandle accumulators_, modes_;
    WriteHandle timer_;
    bool has_timer_, has_latch_, has_tables_;
};

}  // namespace

std::unique_ptr<Module> make_stepgens(const ModuleRequest &request) {
    return std::make_unique<Stepgens>(request);
}

}  // namespace mw::mesa
