// SPDX-License-Identifier: GPL-2.0-or-later
// Modules of a rotary table under a head with an inclined axis (kinematics/nutating_head.hh): type 0 is
// identity, type 1 programs the tip of the tool on the work, type 2 a tilted plane across the tool.
#pragma once

#include "components/motion/switchable.hh"
#include "kinematics/nutating_head.hh"

namespace mw::components {

/// `Head` defines the axis about which the table turns. Each module has its own; the pins use `name`.
template <class Head>
class LeaningHead {
  public:
    Switchable &switchable() noexcept { return switchable_; }

    /// Creates the pins of `name`_kins. Returns 0 or a negated errno.
    int declare(int comp_id, const char *name, const char *pins, const char *letters) noexcept {
        const char *expected = "xyzabc";
        int i = 0;
        while (expected[i] != '\0' && (letters[i] | 0x20) == expected[i]) {
            ++i;
        }
        if (expected[i] != '\0' || letters[i] != '\0') {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: coordinates=%s: expected XYZABC\n", name, letters);
            return -EINVAL;
        }
        return pinned_.declare(comp_id, pins);
    }

  private:
    /// The same machine in the coordinates of the tool.
    struct InPlane {
        const PinnedModel<Head> &pinned;

        Head model() const noexcept {
            Head head = pinned.model();
            head.set_frame(kinematics::HeadFrame::TOOL);
            return head;
        }
        kinematics::Status forward(const double *joints, kinematics::Pose &pose) const noexcept {
            return model().forward(joints, pose);
        }
        kinematics::Status inverse(const kinematics::Pose &pose, double *joints) const noexcept {
            return model().inverse(pose, joints);
        }
    };

    PinnedModel<Head> pinned_;
    InPlane in_plane_{pinned_};
    PartOf<PinnedModel<Head>> on_work_{pinned_};
    PartOf<InPlane> across_tool_{in_plane_};
    Switchable switchable_{&on_work_, &across_tool_};
};

}  // namespace mw::components
