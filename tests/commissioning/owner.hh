// SPDX-License-Identifier: GPL-2.0-or-later
// An owner: follows the texts of the steps at the machine, with a caliper, an indicator and a
// tachometer.
#pragma once

#include <map>
#include <optional>
#include <random>
#include <string>

#include "commissioning/world.hh"
#include "machine/commissioning/prompt.hh"

namespace mw::commissioning_campaign {

class Owner {
  public:
    Owner(World &world, unsigned seed, bool isRewiring)
        : world_(world), random_(seed + 13), isRewiring_(isRewiring) {}

    /// The owner's action in this cycle, from the text on the screen and the state of the machine; empty:
    /// waits.
    std::optional<commissioning::Act> look(int prompt_number, const commissioning::Prompt &prompt,
                                           double now_s);

  private:
    std::optional<commissioning::Act> read(const commissioning::Prompt &prompt);
    std::optional<commissioning::Act> hold(const commissioning::Prompt &prompt);
    commissioning::Act say(const commissioning::Prompt &prompt);
    commissioning::Act measure(const commissioning::Prompt &prompt);
    void use_hands(const std::string &text);
    /// The axis that the text names: "X" in "Read the gauge on X."
    std::size_t axis_in(const std::string &text) const;
    double noise(double most);

    World &world_;
    std::mt19937 random_;
    bool isRewiring_;
    int number_ = -1;
    double seen_s_ = 0;
    bool isDone_ = false, isReleased_ = false;
    std::size_t held_axis_ = 0;
    double held_from_ = 0;  ///< position of the table when the button was pressed
    std::map<std::size_t, double> zero_;
};

}  // namespace mw::commissioning_campaign
