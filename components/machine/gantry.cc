// SPDX-License-Identifier: GPL-2.0-or-later
// gantry: several motors move one axis and home to separate switches; `personality=` gives their number, up
// to 7.
//
// Function gantry.N.read: `home` (bit) is true when all `joint.NN.home` (bit) are, `limit` when any is;
// `position-fb` is joint.NN.pos-fb + joint.NN.offset of one joint: the one that reached its switch last.
// Function gantry.N.write: `joint.NN.pos-cmd` is `position-cmd` less the joint's offset. While position-cmd
// moves in the direction of `search-vel` and some switches are made and some not, the joints at their switch
// do not move and their offset changes instead. Positions [machine units] are float. A command that is not a
// number is not passed on.
#include <cmath>

#include "hal/sdk/component.hh"

MW_PERSONALITY("joints of each instance");

namespace mw::components {
using namespace sdk;

struct GantryJoint {
    Out<double> pos_cmd;
    In<double> pos_fb;
    In<bool> home;
    Out<double> offset;
};

struct Gantry {
    static constexpr int MAX_JOINTS = 7;
    int joints = 0;
    GantryJoint joint[MAX_JOINTS];
    In<double> position_cmd, search_vel;
    Out<double> position_fb;
    Out<bool> home, limit;
    double last_cmd = 0.0;
    int fb_joint = 0;

    void declare(Declare &d) noexcept {
        joints = d.personality_number(personality[d.index()], 0, MAX_JOINTS, "joints");
        for (int i = 0; i < joints; ++i) {
            d.pin_at(joint[i].pos_cmd, "joint.%02d.pos-cmd", i);
            d.pin_at(joint[i].pos_fb, "joint.%02d.pos-fb", i);
            d.pin_at(joint[i].home, "joint.%02d.home", i);
            d.pin_at(joint[i].offset, "joint.%02d.offset", i);
        }
        d.pin(position_cmd, "position-cmd");
        d.pin(position_fb, "position-fb");
        d.pin(home, "home");
        d.pin(limit, "limit");
        d.pin(search_vel, "search-vel");
        d.function<&Gantry::read>(this, "read");
        d.function<&Gantry::write>(this, "write");
    }

    void read() noexcept {
        const int made = joints_at_switch();
        home = joints > 0 && made == joints;
        limit = made > 0;
        if (made > 0 && made < joints && joint[fb_joint].home) {
            fb_joint = first_joint_on_the_way();
        }
        if (joints > 0) {
            set_finite(position_fb, joint[fb_joint].pos_fb + joint[fb_joint].offset);
        }
    }

    void write() noexcept {
        const double command = position_cmd;
        if (!std::isfinite(command)) {
            return;
        }
        const double way = command - last_cmd;
        last_cmd = command;
        const int made = joints_at_switch();
        const bool homing = made > 0 && made < joints && way * search_vel > 0.0;
        for (int i = 0; i < joints; ++i) {
            if (homing && joint[i].home) {
                joint[i].offset = joint[i].offset + way;
            }
            joint[i].pos_cmd = command - joint[i].offset;
        }
    }

  private:
    int joints_at_switch() const noexcept {
        int made = 0;
        for (int i = 0; i < joints; ++i) {
            made += joint[i].home ? 1 : 0;
        }
        return made;
    }
    int first_joint_on_the_way() const noexcept {
        int found = 0;
        while (found < joints - 1 && joint[found].home) {
            ++found;
        }
        return found;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Gantry, "gantry", mw::sdk::MANY);
