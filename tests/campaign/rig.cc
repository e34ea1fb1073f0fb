// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/rig.hh"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace mw::campaign {
namespace {

constexpr std::int64_t PERIOD_NS = 1000000;
constexpr double PERIOD_S = 1e-3;
constexpr double NAN_VALUE = std::numeric_limits<double>::quiet_NaN();
constexpr int CONFIGURE_CYCLES = 2000;
/// Acceleration of the spindle [rpm/s], and the permitted deviation of its speed.
constexpr double SPINDLE_RAMP = 8000, AT_SPEED_RPM = 5;
constexpr double AMPLIFIER_RISE_S = 0;

}  // namespace

Result<runtime::PeriodicId> LateScheduler::add(const runtime::PeriodicSpec &spec) {
    if (spec.order != runtime::Order::PLANNER) {
        return clock_.add(spec);
    }
    planner_ = spec;
    runtime::PeriodicSpec mine = spec;
    mine.function = plan;
    mine.argument = this;
    return clock_.add(mine);
}

void LateScheduler::plan(void *self, std::int64_t period_ns) {
    const auto &scheduler = *static_cast<LateScheduler *>(self);
    if (!scheduler.isPlannerHeld) {
        scheduler.planner_.function(scheduler.planner_.argument, period_ns);
    }
}

Rig::Rig(const Design &design, std::uint64_t seed, std::string ini)
    : design_(design), ini_(std::move(ini)), spindle_(design.spindle) {
    for (const JointDesign &j : design.joints) {
        const double shaft = j.start + j.screw_error_at(j.start) + j.shaft_offset;
        plants::AxisSettings drive = j.drive;
        drive.backlash = j.play;
        const plants::EncoderSettings encoder{j.counts_per_unit, j.index_spacing,
                                              j.index_at + j.shaft_offset};
        const plants::SwitchSettings home{j.home_switch_at, false, 0, j.hysteresis, j.bounce_s};
        plants_.push_back({plants::Axis(drive, shaft), plants::Encoder(encoder, shaft),
                           plants::BouncingSwitch(home, seed + plants_.size()),
                           plants::Amplifier(AMPLIFIER_RISE_S)});
    }
    joint_faults.resize(plants_.size());
    sample_.joints.resize(plants_.size());
}

Rig::~Rig() {
    // The task side ends first, because its pins belong to the host's instance and the host's periodic
    // function runs it.
    if (periodic_.value != 0) {
        scheduler_.remove(periodic_);
    }
    side_.reset();
    host_.reset();
}

std::string Rig::start() {
    const auto told = [this](const std::string &what) {
        std::string text = what;
        for (const auto &d : sink_.all()) {
            text += "; " + d.str();
        }
        return text;
    };
    loaded_ = machine::LoadedConfig::load(ini_, sink_);
    if (!loaded_) {
        return told("the INI file has errors");
    }
    loaded_->machine.task.parameter_file.clear();
    hal::InstanceOptions options;
    options.scheduler = &scheduler_;
    auto host = hal::LocalHost::create(options);
    if (!host) {
        return told(host.error().str());
    }
    host_ = std::move(*host);
    const machine::MachineParts parts{loaded_->ini, loaded_->reader, loaded_->machine, sink_};
    side_ = std::make_unique<machine::TaskSide>(parts, *host_, mailbox::Memory::in_process(), nullptr);
    const hal::UseInstance use(&host_->hal());
    machine::MachineOptions machine_options;
    machine_options.clock_virtual = true;
    if (const auto started = side_->start(machine_options); !started) {
        return told(started.error().str());
    }
    if (const std::string missing = pins_.bind(host_->hal(), plants_.size()); !missing.empty()) {
        return "no pin " + missing;
    }
    const auto periodic =
        scheduler_.add({"task", PERIOD_NS, runtime::Order::TASK,
                        [](void *self, std::int64_t) { static_cast<Rig *>(self)->step_task(); }, this});
    if (!periodic) {
        return periodic.error().str();
    }
    periodic_ = *periodic;
    const auto ready = side_->finish_start(*this, CONFIGURE_CYCLES);
    return ready ? std::string() : told(ready.error().str());
}

void Rig::step_task() {
    if (!faults.isTaskHeld && !faults.isTaskDead) {
        side_->step(scheduler_.now_ns());
    }
}

void Rig::cycle() {
    *pins_.chain = *pins_.user_enable && !faults.isChainOpen;
    *pins_.enable = !faults.isDisabled;
    *pins_.probe = faults.isProbeClosed || isProbeTouching();
    *pins_.inhibit = faults.isFeedInhibited;
    *pins_.adaptive_feed = faults.isAdaptiveNan ? NAN_VALUE : faults.adaptive_feed;
    constexpr std::uint64_t INPUT_MS = 150;
    *pins_.input = cycles_ / INPUT_MS % 2 != 0;
    *pins_.spindle.amp_fault = faults.isSpindleFaulted;
    if (faults.isTaskDead) {
        side_->channels().isTaskDead.store(1);
    }
    run_plants();
    constexpr double WELL_WITHIN = 0.5;
    areWallsUp_ = areWallsUp_ || (!walls_.empty() && std::ranges::all_of(walls_, [this](const Wall &w) {
                      return beyond_wall(w) < -WELL_WITHIN;
                  }));
    ++cycles_;
    const bool isChainClosed = *pins_.chain;
    scheduler_.run_until(static_cast<std::int64_t>(cycles_) * PERIOD_NS);
    sample_.isChainClosed = isChainClosed;
    sample_.isEnableOn = !faults.isDisabled;
    take_sample();
}

/// A period of the plants between two servo cycles: from the commands of the motors to the measured values.
void Rig::run_plants() {
    for (std::size_t j = 0; j < plants_.size(); ++j) {
        Plant &p = plants_[j];
        const JointPins &pins = pins_.joints[j];
        const bool isPowered = p.amplifier.run(*pins.is_amp_on, PERIOD_S);
        if (isPowered && !p.wasPowered) {
            p.axis.hold_here();
        }
        p.wasPowered = isPowered;
        p.axis.run(*pins.motor_cmd + p.encoder.zero(), isPowered, PERIOD_S);
        const double before = p.encoder.zero();
        if (p.encoder.run(p.axis.motor(), *pins.index_enable)) {
            *pins.index_enable = false;
            p.turned += p.encoder.zero() - before;
            ++p.resets;
            p.isTruthKnown = true;
        }
        *pins.motor_fb = joint_faults[j].isEncoderNan ? NAN_VALUE : p.encoder.reading();
        p.slide = design_.joints[j].slide_at(p.axis.load() - design_.joints[j].shaft_offset);
        *pins.home_switch = p.home_switch.run(p.slide, PERIOD_S);
        *pins.pos_limit = joint_faults[j].isOnLimit;
        *pins.amp_fault = p.amplifier.isFaulted();
    }
    run_spindle();
}

void Rig::run_spindle() {
    const double wanted = *pins_.spindle.speed_out;
    if (design_.hasSpindlePlant) {
        spindle_.run(std::isfinite(wanted) ? wanted / 60 : 0, 0, PERIOD_S);
        spindle_rpm_ = 60 * spindle_.speed();
        spindle_turns_ = spindle_.turns();
    } else {
        const double change =
            std::clamp(wanted - spindle_rpm_, -SPINDLE_RAMP * PERIOD_S, SPINDLE_RAMP * PERIOD_S);
        spindle_rpm_ += std::isfinite(change) ? change : 0;
        spindle_turns_ += spindle_rpm_ / 60 * PERIOD_S;
    }
    const double shown = design_.hasSpindlePlant ? spindle_.shown_turns() : spindle_turns_;
    *pins_.spindle.at_speed = std::abs(wanted - spindle_rpm_) < AT_SPEED_RPM;
    *pins_.spindle.revs = faults.isSpindleNan ? NAN_VALUE : shown;
    *pins_.spindle.speed_in = faults.isSpindleNan ? NAN_VALUE : spindle_rpm_ / 60;
}

void Rig::take_sample() {
    sample_.cycle = cycles_;
    for (std::size_t j = 0; j < plants_.size(); ++j) {
        const Plant &p = plants_[j];
        const JointPins &pins = pins_.joints[j];
        JointSample &out = sample_.joints[j];
        out.pos_cmd = *pins.pos_cmd;
        out.pos_fb = *pins.pos_fb;
        out.motor_cmd = *pins.motor_cmd;
        out.motor_fb = *pins.motor_fb;
        out.turned = p.turned;
        out.resets = p.resets;
        out.position = p.slide;
        out.isTruthKnown = p.isTruthKnown;
        out.offset =
            design_.isTrivial
                ? *pins_.offsets[static_cast<std::size_t>(geometry::axis_of_letter(design_.coordinates[j]))]
                       .offset
                : 0;
        out.isAmpOn = *pins.is_amp_on;
        out.isHomed = *pins.is_homed;
        out.isHoming = *pins.is_homing;
        out.isAmpFaulted = *pins.amp_fault;
    }
    for (std::size_t i = 0; i < pins_.axes.size(); ++i) {
        sample_.axes.c[i] = *pins_.axes[i];
        sample_.offsets.c[i] = *pins_.offsets[i].offset;
    }
    sample_.areAxesKnown = *pins_.are_all_homed && (*pins_.is_coord || *pins_.is_teleop);
    sample_.isSpindleOn = *pins_.spindle.is_on;
    sample_.spindle_rpm = *pins_.spindle.speed_out;
    sample_.spindle_turns = spindle_turns_;
    sample_.outputs = 0;
    for (std::size_t i = 0; i < pins_.outputs.size(); ++i) {
        sample_.outputs |= *pins_.outputs[i] ? 1U << i : 0U;
    }
}

bool Rig::isSwitchedOn() const {
    return std::ranges::any_of(sample_.joints, [](const JointSample &j) { return j.isAmpOn; });
}

void Rig::set_contacts(const std::vector<Contact> &contacts) {
    walls_.clear();
    areWallsUp_ = false;
    for (const Contact &c : contacts) {
        const std::size_t joint = design_.coordinates.find(geometry::AXIS_LETTERS[c.axis]);
        // Positions of machine and plant differ for joints that are homed at their position.
        const double by = plants_[joint].slide - sample_.joints[joint].pos_cmd;
        walls_.push_back({joint, {c.axis, c.low + by, c.high + by}});
    }
}

double Rig::beyond_walls(int axis) const {
    if (!areWallsUp_) {
        return -1;
    }
    double beyond = -1;
    for (const Wall &w : walls_) {
        beyond = w.at.axis == axis ? beyond_wall(w) : beyond;
    }
    return beyond;
}

double Rig::beyond_wall(const Wall &wall) const {
    const double tip = plants_[wall.joint].slide;
    return std::max(tip - wall.at.high, wall.at.low - tip);
}

bool Rig::isProbeTouching() const {
    return std::ranges::any_of(walls_, [this](const Wall &w) { return areWallsUp_ && beyond_wall(w) > 0; });
}

void Rig::add_offset(int axis, double by) {
    constexpr double SCALE = 0.01;
    const OffsetPins &pins = pins_.offsets[static_cast<std::size_t>(axis)];
    *pins.scale = SCALE;
    *pins.is_enabled = true;
    *pins.counts = *pins.counts + static_cast<std::int32_t>(std::lround(by / SCALE));
}

void Rig::clear_offsets(bool isWanted) {
    for (const OffsetPins &pins : pins_.offsets) {
        *pins.is_clearing = isWanted;
    }
}

bool Rig::hasOffset() const {
    return std::ranges::any_of(pins_.offsets,
                               [](const OffsetPins &p) { return *p.offset != 0 || *p.request != 0; });
}

bool Rig::areOffsetsThere() const {
    return *pins_.is_offset_limited || std::ranges::all_of(pins_.offsets, [](const OffsetPins &p) {
        return std::abs(*p.offset - *p.request) < 1e-9;
    });
}

void Rig::link_wheel(const Turning *turning, int target) {
    if (wheel_ != nullptr) {
        *wheel_->is_enabled = false;
    }
    wheel_ = nullptr;
    if (turning == nullptr) {
        return;
    }
    const auto n = static_cast<std::size_t>(target);
    wheel_ = turning->isJoint ? &pins_.joint_wheels[n] : &pins_.axis_wheels[n];
    *wheel_->scale = turning->scale;
    *wheel_->is_velocity_mode = turning->isVelocityMode;
    *wheel_->accel_fraction = turning->accel_fraction;
    *wheel_->is_enabled = true;
}

void Rig::turn_wheel(int counts) {
    *wheel_->counts = *wheel_->counts + counts;
}

void Rig::lose_encoder(int joint, bool isLost) {
    Plant &p = plants_[static_cast<std::size_t>(joint)];
    p.encoder.lose(isLost);
    p.isTruthKnown = false;
}

void Rig::jump_encoder(int joint, double by) {
    Plant &p = plants_[static_cast<std::size_t>(joint)];
    p.encoder.jump(by);
    p.isTruthKnown = false;
}

void Rig::repair() {
    for (std::size_t j = 0; j < plants_.size(); ++j) {
        plants_[j].encoder.lose(false);
        plants_[j].amplifier.reset();
        joint_faults[j] = {};
    }
    faults = {};
    scheduler_.isPlannerHeld = false;
}

/// Deviation of a joint from the first joint of its axis, by its motor.
double Rig::askew(std::size_t joint) const {
    const std::size_t first =
        design_.isTrivial ? design_.coordinates.find(design_.coordinates[joint]) : joint;
    const auto place = [this](std::size_t j) {
        return plants_[j].axis.motor() - design_.joints[j].shaft_offset;
    };
    return place(joint) - place(first);
}

bool Rig::isAskew() const {
    constexpr double VISIBLE = 0.5;
    for (std::size_t j = 0; j < plants_.size(); ++j) {
        if (std::abs(askew(j)) > VISIBLE) {
            return true;
        }
    }
    return false;
}

void Rig::straighten() {
    for (std::size_t j = 0; j < plants_.size(); ++j) {
        if (const double by = askew(j); by != 0) {
            plants_[j].axis.turn_by_hand(plants_[j].axis.motor() - by);
        }
    }
}

void Rig::trust_encoders() {
    for (Plant &p : plants_) {
        p.isTruthKnown = true;
    }
}

}  // namespace mw::campaign
