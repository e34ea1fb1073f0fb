// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that probe.
#include <cmath>

#include <fmt/format.h>

#include "campaign/program_writer.hh"

namespace mw::campaign {
namespace {

constexpr int TOWARDS = 2, TOWARDS_MAYBE = 3, AWAY = 4, AWAY_MAYBE = 5;  // G38.2 to .5

}  // namespace

/// The speed of a probing move, whose result the program prints.
double Writer::probe(const Contact &contact, bool isHigh, int kind, double to) {
    const double from = at_[contact.axis];
    const double wall = isHigh ? contact.high : contact.low;
    const bool wasOut = from > contact.high || from < contact.low;
    const bool isOut = to > contact.high || to < contact.low;
    feed_ = std::round(std::pow(10.0, random_.real(1.8, 3.3)));
    at_[contact.axis] = to_grid(to);
    push(fmt::format("G38.{} {}{:.4f} F{:.0f}", kind, geometry::AXIS_LETTERS[contact.axis], at_[contact.axis],
                     feed_),
         false);
    blocks_.back().probe = {contact.axis, wasOut != isOut, wall, feed_ / 60};
    say(fmt::format("(debug,probe #5070 #{})", 5061 + contact.axis));
    return feed_ / 60;
}

/// A probing move that must end the program.
bool Writer::probe_wrongly(const Contact &contact, bool isHigh, bool isTouching) {
    const double middle = 0.5 * (contact.low + contact.high);
    const double wall = isHigh ? contact.high : contact.low;
    const double inside = wall + 0.3 * (middle - wall);
    const double outside = wall + (isHigh ? 3 : -3);
    // has contact at its start, or finds no contact
    const int kind = isTouching || random_.chance(0.5) ? TOWARDS : AWAY;  // has no contact
    probe(contact, isHigh, kind, isTouching ? outside : inside);
    return true;
}

Act Writer::write_probing() {
    Act act;
    act.work = Work::PROBE;
    say("G21 G90 G17 G94 G80 G40");
    set_mode();
    move_to_start();
    for (const AxisDesign &a : design_.axes) {
        // The probe can stop between the walls and the soft limits.
        act.contacts.push_back(
            {a.axis, to_grid(at_[a.axis] - random_.real(2, 8)), to_grid(at_[a.axis] + random_.real(2, 8))});
    }
    const geometry::Pose start = at_;
    const int count = random_.whole(1, 4);
    for (int n = 0; n < count && !act.isToFail; ++n) {
        const Contact &c = act.contacts[static_cast<std::size_t>(
            random_.whole(0, static_cast<int>(act.contacts.size()) - 1))];
        const bool isHigh = random_.chance(0.5);
        const double wall = isHigh ? c.high : c.low;
        const bool isMiss = random_.chance(0.2);
        if (random_.chance(0.15)) {
            act.isToFail = probe_wrongly(c, isHigh, false);
        } else if (isMiss) {
            probe(c, isHigh, TOWARDS_MAYBE, wall + 0.2 * (start[c.axis] - wall));
        } else {
            const double beyond = isHigh ? 1 : -1;
            probe(c, isHigh, random_.whole(TOWARDS, TOWARDS_MAYBE), wall + beyond * random_.real(1, 4));
            if (random_.chance(0.15)) {
                act.isToFail = probe_wrongly(c, isHigh, true);
            } else if (random_.chance(0.5)) {
                probe(c, isHigh, random_.whole(AWAY, AWAY_MAYBE), start[c.axis]);
            }
        }
        at_ = start;
        push(fmt::format("G0 {}{:.4f}", geometry::AXIS_LETTERS[c.axis], at_[c.axis]), true);
    }
    say("M2");
    act.blocks = std::move(blocks_);
    return act;
}

}  // namespace mw::campaign
