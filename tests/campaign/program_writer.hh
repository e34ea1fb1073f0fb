// SPDX-License-Identifier: GPL-2.0-or-later
// Writes programs and records their path.
#pragma once

#include <string>
#include <vector>

#include "campaign/plan.hh"

namespace mw::campaign {

/// Rounds to the number of digits in programs.
double to_grid(double x);

class Writer {
  public:
    Writer(plants::Random &random, const Design &design) : random_(random), design_(design) {}

    /// The program may wait for inputs (M66) and have adaptive feed (M52). Returns true when it does.
    bool allow_waits();
    /// A program of lines and arcs that takes about this time at its feeds.
    std::vector<Block> write(double seconds);
    /// Probes the walls of a room and retracts, or misses the walls.
    Act write_probing();
    /// Moves that are synchronized with the spindle.
    Act write_in_step();

  private:
    void write_threads(SyncWish &sync);
    void write_cycle(SyncWish &sync);
    void write_taps(SyncWish &sync);
    void write_per_turn(SyncWish &sync);
    void write_surface(SyncWish &sync);
    double speed_for_z(double share) const;
    double way_to_speed(double v) const;
    void start_spindle(double rpm);
    double probe(const Contact &contact, bool isHigh, int kind, double to);
    bool probe_wrongly(const Contact &contact, bool isHigh, bool isTouching);

    bool hasAxis(int axis) const;
    const AxisDesign &axis(int letter) const;
    void say(const std::string &text);
    void set_mode();
    void spindle();
    void output();
    double place(const AxisDesign &a);
    void move_to_start();
    void push(const std::string &text, bool isRapid);
    std::string feed_word();
    double line();
    double arc();

    plants::Random &random_;
    const Design &design_;
    std::vector<Block> blocks_;
    geometry::MoveSettings settings_;
    geometry::Pose at_;
    double feed_ = 1000;
    bool mayWait_ = false, isAdaptive_ = false;
};

}  // namespace mw::campaign
