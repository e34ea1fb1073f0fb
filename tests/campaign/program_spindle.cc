// SPDX-License-Identifier: GPL-2.0-or-later
// Programs whose motion is synchronized with the spindle.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "campaign/program_writer.hh"

namespace mw::campaign {

/// A fraction of the speed that Z permits.
double Writer::speed_for_z(double share) const {
    const AxisDesign z = design_.z_with_joints();
    return share * std::min((1 - z.offset_ratio) * z.velocity, design_.velocity);
}

/// Along Z, as a thread gains speed: with jerk limits part of the acceleration is kept for the spindle.
double Writer::way_to_speed(double v) const {
    const AxisDesign z = design_.z_with_joints();
    const double a = 0.45 * std::min(z.acceleration_of_path(), design_.acceleration);
    const double jerk =
        z.jerk > 0 && design_.jerk > 0 ? std::min(z.jerk, design_.jerk) : std::max(z.jerk, design_.jerk);
    const double rise_s = design_.isJerkLimited && jerk > 0 ? 2 * a / jerk : 0;
    return v * v / (2 * a) + v * rise_s;
}

void Writer::start_spindle(double rpm) {
    say(fmt::format("M{} S{:.0f}", rpm > 0 ? 3 : 4, std::abs(rpm)));
    Block b;
    b.text = "G4 P1";
    b.dwell_s = 1;
    blocks_.push_back(b);
}

/// Passes of G33 at one or two depths.
void Writer::write_threads(SyncWish &sync) {
    const AxisDesign &x = axis(geometry::AXIS_X);
    sync.kind = Sync::THREAD;
    sync.passes = random_.whole(1, 3);
    for (int n = 0; n < sync.passes; ++n) {
        const double depth = to_grid(at_[geometry::AXIS_X] + 0.01 * n * (x.high - x.low));
        say(fmt::format("G0 X{:.4f} Z{:.4f}", depth, sync.from));
        say(fmt::format("G33 Z{:.4f} K{:.4f}", sync.to, sync.lead));
        say(fmt::format("G0 X{:.4f}", depth + 0.5));
        say(fmt::format("G0 Z{:.4f}", sync.from));
    }
}

void Writer::write_cycle(SyncWish &sync) {
    sync.kind = Sync::THREAD;
    sync.passes = 2;
    say(design_.coordinates.find('Y') == std::string::npos || random_.chance(0.5) ? "G18" : "G18");
    say(fmt::format("G0 X{:.4f} Z{:.4f}", at_[geometry::AXIS_X] + 2, sync.from));
    say(fmt::format("G76 P{:.4f} Z{:.4f} I-1 J0.4 K0.7 R1 Q0 H1", sync.lead, sync.to));
    say("G17");
}

void Writer::write_taps(SyncWish &sync) {
    sync.kind = Sync::TAP;
    sync.passes = random_.whole(1, 2);
    for (int n = 0; n < sync.passes; ++n) {
        say(fmt::format("G33.1 Z{:.4f} K{:.4f}", sync.to, sync.lead));
    }
}

void Writer::write_per_turn(SyncWish &sync) {
    sync.kind = Sync::PER_TURN;
    sync.passes = 1;
    say(fmt::format("G95 G1 Z{:.4f} F{:.4f}", sync.to, sync.lead));
    say("G94");
}

void Writer::write_surface(SyncWish &sync) {
    const AxisDesign &x = axis(geometry::AXIS_X);
    sync.kind = Sync::SURFACE;
    sync.passes = 1;
    sync.lead = std::round(random_.real(10, 80));
    sync.rpm = std::round(random_.real(500, 2500));
    sync.from = to_grid(random_.real(0.5, 0.9) * x.high);
    sync.to = to_grid(random_.real(0.02, 0.4) * x.high);
    say(fmt::format("G0 X{:.4f}", sync.from));
    say(fmt::format("G96 D{:.0f} S{:.0f} M3", sync.rpm, sync.lead));
    say("G4 P1");
    say(fmt::format("G1 X{:.4f} F{:.0f}", sync.to,
                    std::round((sync.from - sync.to) / random_.real(0.4, 1.2) * 60)));
    say("G97 S300");
}

Act Writer::write_in_step() {
    Act act;
    act.work = Work::SPINDLE;
    SyncWish &sync = act.sync;
    const AxisDesign z = design_.z_with_joints();
    say("G21 G90 G17 G94 G80 G40 G97 G8");
    set_mode();
    move_to_start();
    int kind = random_.whole(0, 4);
    kind = kind == 2 && z.offset_ratio > 0 ? 0 : kind;
    kind = design_.isTrivial ? kind : 2;
    // On other machines a Z move tilts the tool or needs curved joint moves, which need more than Z itself.
    const bool isPlainZ = design_.isTrivial || design_.name == "corexy" || design_.name == "delta" ||
                          design_.name == "scarakins" || design_.name == "rosekins";
    if (kind == 4) {
        write_surface(sync);
    } else {
        const double turns_s = random_.real(100, 1500) / 60;
        bool isTap = kind == 2;
        bool isSudden = false;
        sync.rpm = std::round(60 * turns_s) * (isTap || random_.chance(0.7) ? 1 : -1);
        const double most = speed_for_z(0.45) / std::abs(sync.rpm / 60);
        sync.lead = to_grid(std::min(random_.real(0.3, 3), most));
        if (isTap) {
            // While the spindle reverses, the tool changes its speed with the same acceleration.
            const double a = 0.4 * std::min(z.acceleration, design_.acceleration);
            sync.lead = to_grid(std::min(sync.lead, a / design_.spindle.ramp));
            if (design_.isJerkLimited) {
                // A tap that would leave its thread is rejected; between the two bounds both results are
                // correct.
                constexpr double WELL = 0.08, BADLY = 0.12;
                isSudden = design_.off_helix(sync.lead, design_.gentlest_ramp(turns_s)) > BADLY;
                const bool isWell = design_.off_helix(sync.lead, design_.spindle.ramp) < WELL;
                isTap = isSudden || isWell;
                kind = isTap ? kind : 0;
            }
        }
        if (kind == 0 && !design_.isTrivial) {
            kind = 3;  // threads of these plans have a time limit only
        }
        const double v = sync.lead * std::abs(sync.rpm) / 60;
        const double overrun = isTap ? sync.lead * turns_s * (turns_s / design_.spindle.ramp + 0.04) : 0;
        const double length = 3 * way_to_speed(v) + 3 * overrun + random_.real(4, 12) * sync.lead + 0.2 * v;
        // Starts from the middle if the travel is sufficient.
        const double side = random_.chance(0.5) ? 1 : -1;
        const double middle = z.low > 0 || z.high < 0 ? to_grid(0.5 * (z.low + z.high)) : 0;
        sync.from = to_grid(middle - side * 0.4 * length);
        sync.to = to_grid(sync.from + side * length);
        const double room = std::min(z.high - middle, middle - z.low);
        const bool fits =
            std::max(std::abs(sync.from - middle), std::abs(sync.to - middle)) + 3 * sync.lead < 0.95 * room;
        const double far = middle - side * std::min(std::abs(sync.from - middle), 0.9 * room);
        sync.from = fits ? sync.from : to_grid(far);
        sync.to = fits ? sync.to : to_grid(sync.from + side * 0.1);
        // The move is too short for the speed or for the spindle; a feed per revolution may be short. With
        // little travel, a move that is too short may still be slow enough.
        act.isToFail = !fits && kind != 3 && design_.isTrivial;
        act.mayFail = isSudden || !isPlainZ || (!fits && !design_.isTrivial);
        sync.isShort = !fits;
        start_spindle(sync.rpm);
        say(fmt::format("G0 Z{:.4f}", sync.from));
        switch (kind) {
        case 0: write_threads(sync); break;
        case 1: write_cycle(sync); break;
        case 2: write_taps(sync); break;
        default: write_per_turn(sync); break;
        }
    }
    say("M5");
    say("M2");
    act.blocks = std::move(blocks_);
    return act;
}

}  // namespace mw::campaign
