// SPDX-License-Identifier: GPL-2.0-or-later
// Pins of omitted programs, so that lines of HAL files that name them still work.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/core/instance.hh"

namespace mw::hal::script {

class Placeholders {
  public:
    explicit Placeholders(Instance &hal) : hal_(hal) {}

    /// Adds a program that was not started: pins whose name starts with its component or one of its words
    /// belong to it.
    void add_program(const std::string &component, const std::vector<std::string> &argv);
    /// True when pin `name` does not exist and belongs to an omitted program.
    bool covers(const std::string &name) const;
    /// Links the pin to a signal: as an input of the signal's type, at once or when the signal exists.
    Result<> link(const std::string &pin, const std::string &signal);
    /// Links pins that waited for `signal`, which exists now.
    Result<> signal_made(const std::string &signal);
    /// A line sets such a pin: the value is not stored, because nothing reads it; the pin is recorded.
    void note(const std::string &pin);

    /// The omitted programs: one line for each, with its pins.
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

    Instance &hal_;
    int comp_id_ = 0;
    std::vector<Program> programs_;
    std::vector<Waiting> waiting_;
};

}  // namespace mw::hal::script
