// SPDX-License-Identifier: GPL-2.0-or-later
// The simulated machine around the controller: motors, switches and the readings of instruments. It uses the
// pins of the boards, and nothing of the commissioning library.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "commissioning/true_machine.hh"
#include "drivers/mesa/board/hand_panel.hh"
#include "hal/core/instance.hh"
#include "machine/assembly/machine.hh"

namespace mw::commissioning_campaign {

class World {
  public:
    World(const TrueMachine &machine, std::string folder);

    /// Before a start of the controller, creates the hardware for the files in its current positions. Returns
    /// the INI file to start.
    Result<std::string> prepare(const std::string &ini);
    void connect(machine::Machine &machine) { controller_ = &machine; }
    /// Called after each task cycle.
    void step();

    std::size_t find_axis(char letter) const;
    double table(std::size_t axis) const { return tables_[axis]; }
    const TrueAxis &axis(std::size_t axis) const { return machine_.axes[axis]; }
    double spindle_rpm() const;
    /// Drives that have an enable signal.
    int count_enabled() const;
    /// Steps were lost since the last start.
    bool hasSlipped() const;
    /// An end stop that was hit, or steps that were lost; empty: none.
    const std::string &damage() const { return damage_; }

    void press_switch(std::size_t axis, bool isPressed);
    void press_estop(bool isPressed);
    void touch_probe(bool isTouched);

  private:
    /// The input to which the switch of an axis is connected.
    std::size_t switch_place(std::size_t axis) const;
    bool isPort() const { return machine_.board == Board::PARPORT; }
    std::string port_text() const;
    std::string physics_text() const;
    void set(const std::string &pin, double value);
    double get(const std::string &pin) const;
    double motor_position(std::size_t axis) const;
    void make_noise();
    void show_hands();

    const TrueMachine &machine_;
    std::string folder_;
    std::shared_ptr<mesa::board::HandPanel> panel_;
    machine::Machine *controller_ = nullptr;
    std::vector<double> tables_, motors_;
    std::vector<bool> pressed_;
    bool isEstopPressed_ = false, isProbeTouched_ = false;
    std::mt19937 random_;
    std::string damage_;
};

}  // namespace mw::commissioning_campaign
