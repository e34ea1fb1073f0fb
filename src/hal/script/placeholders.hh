// SPDX-License-Identifier: GPL-2.0-or-later
// Pins of programs that were left out: so that the lines of HAL files which name them still do what they can.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/core/hal.hh"

namespace mw::hal::script {

class Placeholders {
  public:
    explicit Placeholders(Hal &hal) : hal_(hal) {}

    /// A program that was not started: pins whose name starts with its component or one of its words are its
    /// own.
    void add_program(const std::string &component, const std::vector<std::string> &argv);
    /// True when pin `name` does not exist and would belong to a program that was left out.
    bool covers(const std::string &name) const;
    /// Links the pin to a signal: as an input of the signal's type, at once or as soon as the signal exists.
    Result<> link(const std::string &pin, const std::string &signal);
    /// Links what waited for `signal`, which exists now.
    Result<> signal_made(const std::string &signal);
    /// A value that a line gives to such a pin: kept nowhere, as nobody reads it; the pin is noted.
    void note(const std::string &pin);

    /// What was left out: a line a program with its pins.
    std::vector<std::string> report() const;

  private:
    struct Program {
        std::string component;
        std::string command;
        std::vector<std::string> words;
        std::vector<std::string> pins;
    };
    struct Waiting {
        std::string pin;
        std::string signal;
    };
    Program *owner_of(const std::string &pin);
    const Program *owner_of(const std::string &pin) const;
    Result<> make(const std::string &pin, const std::string &signal, Type type);

    Hal &hal_;
    int comp_id_ = 0;
    std::vector<Program> programs_;
    std::vector<Waiting> waiting_;
};

}  // namespace mw::hal::script
