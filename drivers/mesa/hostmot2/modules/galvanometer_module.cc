// SPDX-License-Identifier: GPL-2.0-or-later
#include <array>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/galvanometer.hh"
#include "drivers/mesa/hostmot2/modules/small.hh"

namespace mw::mesa {

namespace {

enum GalvanometerRegister {
    ACCELERATION_X,
    ACCELERATION_Y,
    VELOCITY_X,
    VELOCITY_Y,
    POSITION_X,
    POSITION_Y,
    MODE,
    COMMAND,
    STATUS,
    READ_TIMER,
    WRITE_TIMER,
};

class Galvanometers final : public Module {
  public:
    explicit Galvanometers(const ModuleRequest &request)
        : module_(request.module), instances_(static_cast<std::size_t>(request.module.instances)) {}

    void plan(Registers &registers) override {
        const auto count = static_cast<std::uint16_t>(instances_.size());
        const auto add_read = [&](int reg) {
            return registers.read({module_.address(reg), count}, ReadOrder::INPUT);
        };
        velocity_x_ = add_read(VELOCITY_X);
        velocity_y_ = add_read(VELOCITY_Y);
        position_x_ = add_read(POSITION_X);
        position_y_ = add_read(POSITION_Y);
        modes_ = add_read(MODE);
        status_ = add_read(STATUS);
        const auto add_timer = [&](int reg) {
            return registers.write(module_.address(reg), WriteOrder::CONFIGURATION, Send::CHANGED);
        };
        read_timer_ = add_timer(READ_TIMER);
        write_timer_ = add_timer(WRITE_TIMER);
        int number = 0;
        for (Instance &one : instances_) {
            const auto add = [&](int reg, Send send) {
                return registers.write(module_.address(reg, number), WriteOrder::RATE, send);
            };
            one.command = add(COMMAND, Send::CHANGED);
            one.mode = add(MODE, Send::CHANGED);
            one.handles[0] = {add(POSITION_X, Send::ALWAYS), add(VELOCITY_X, Send::ALWAYS),
                              add(ACCELERATION_X, Send::ALWAYS)};
            one.handles[1] = {add(POSITION_Y, Send::ALWAYS), add(VELOCITY_Y, Send::ALWAYS),
                              add(ACCELERATION_Y, Send::ALWAYS)};
            ++number;
        }
    }
    void declare(PinSpace &space) override {
        int number = 0;
        for (Instance &one : instances_) {
            const std::string name = fmt::format("xy2mod.{:02}", number++);
            declare_axis(space, name, 'x', one.axes[0]);
            declare_axis(space, name, 'y', one.axes[1]);
            binding_.add(space, name + ".enable", PinType::BIT, Access::IN, &one.isEnabled);
            binding_.add(space, name + ".status", PinType::U32, Access::OUT, &one.status);
        }
        binding_.add(space, "xy2mod.read-timer-number", PinType::S32, Access::IN, &read_timer_number_);
        binding_.add(space, "xy2mod.write-timer-number", PinType::S32, Access::IN, &write_timer_number_);
    }
    void read(const Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        int number = 0;
        for (Instance &one : instances_) {
            galvanometer_read(one.axes[0],
                              {registers.value(position_x_, number), registers.value(velocity_x_, number), 0},
                              module_.clock_hz);
            galvanometer_read(one.axes[1],
                              {registers.value(position_y_, number), registers.value(velocity_y_, number), 0},
                              module_.clock_hz);
            galvanometer_overflows(one.axes[0], one.axes[1], registers.value(modes_, number));
            one.status = registers.value(status_, number);
            ++number;
        }
        binding_.store();
    }
    void write(Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        for (Instance &one : instances_) {
            registers.set(one.mode, galvanometer_mode(one.axes[0], one.axes[1], one.isEnabled));
            registers.set(one.command, galvanometer_command(one.axes[0], one.axes[1]));
            for (std::size_t i = 0; i < one.axes.size(); ++i) {
                const GalvanometerWords words =
                    one.isEnabled ? galvanometer_words(one.axes[i], module_.clock_hz) : GalvanometerWords{};
                registers.set(one.handles[i].position, words.position);
                registers.set(one.handles[i].velocity, words.velocity);
                registers.set(one.handles[i].acceleration, words.acceleration);
            }
        }
        registers.set(read_timer_, dpll_timer_choice(read_timer_number_));
        registers.set(write_timer_, dpll_timer_choice(write_timer_number_));
    }

  private:
    struct AxisHandles {
        WriteHandle position, velocity, acceleration;
    };
    struct Instance {
        std::array<GalvanometerPins, 2> axes;
        bool isEnabled = false;
        std::uint32_t status = 0;
        std::array<AxisHandles, 2> handles;
        WriteHandle mode, command;
    };

    void declare_axis(PinSpace &space, const std::string &name, char axis, GalvanometerPins &pins) {
        const auto real = [&](const char *format, Access access, double &value) {
            binding_.add(space, name + "." + fmt::format(fmt::runtime(format), axis), PinType::FLOAT, access,
                         &value);
        };
        const auto bit = [&](const char *format, Access access, bool &value) {
            binding_.add(space, name + "." + fmt::format(fmt::runtime(format), axis), PinType::BIT, access,
                         &value);
        };
        real("pos{}-cmd", Access::IN, pins.pos_cmd);
        real("pos{}-fb", Access::OUT, pins.pos_fb);
        real("vel{}-cmd", Access::IN, pins.vel_cmd);
        real("vel{}-fb", Access::OUT, pins.vel_fb);
        real("acc{}-cmd", Access::IN, pins.acc_cmd);
        real("pos{}-scale", Access::IN, pins.scale);
        bit("pos{}-overflow", Access::OUT, pins.pos_overflow);
        bit("vel{}-overflow", Access::OUT, pins.vel_overflow);
        bit("commandmode{}", Access::IN, pins.is_command_mode);
        bit("18bitmode{}", Access::IN, pins.is18Bit);
        binding_.add(space, fmt::format("{}.control{}", name, axis), PinType::U32, Access::IN, &pins.control);
        binding_.add(space, fmt::format("{}.command{}", name, axis), PinType::U32, Access::IN, &pins.command);
    }

    UsedModule module_;
    std::vector<Instance> instances_;
    std::int32_t read_timer_number_ = -1, write_timer_number_ = -1;
    PinBinding binding_;
    ReadHandle velocity_x_, velocity_y_, position_x_, position_y_, modes_, status_;
    WriteHandle read_timer_, write_timer_;
};

}  // namespace

std::unique_ptr<Module> make_galvanometers(const ModuleRequest &request) {
    return std::make_unique<Galvanometers>(request);
}

}  // namespace mw::mesa
