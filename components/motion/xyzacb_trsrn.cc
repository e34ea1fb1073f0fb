// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a rotary table A under a head whose axis B leans (kins/nutating_head.hh): type 0 is identity,
// type 1 programs the tip of the tool on the work, type 2 a tilted plane across the tool.
#include "components/motion/switchable.hh"
#include "kins/nutating_head.hh"

namespace {

using mw::kins::Pose;
using mw::kins::Status;
using Head = mw::kins::NutatingHeadOverA;

mw::components::PinnedModel<Head> pinned;

/// The same machine in coordinates of the tool.
struct InPlane {
    static Head model() noexcept {
        Head head = pinned.model();
        head.set_frame(mw::kins::HeadFrame::TOOL);
        return head;
    }
    Status forward(const double *joints, Pose &pose) const noexcept { return model().forward(joints, pose); }
    Status inverse(const Pose &pose, double *joints) const noexcept { return model().inverse(pose, joints); }
};

const InPlane in_plane;
const mw::components::PartOf on_work(pinned);
const mw::components::PartOf across_tool(in_plane);
mw::components::Switchable switchable(&on_work, &across_tool);

int declare_model(int comp_id, const char *letters) {
    const char *expected = "xyzabc";
    int i = 0;
    while (expected[i] != '\0' && (letters[i] | 0x20) == expected[i]) {
        ++i;
    }
    if (expected[i] != '\0' || letters[i] != '\0') {
        rtapi_print_msg(RTAPI_MSG_ERR, "xyzacb_trsrn: coordinates=%s: expected XYZABC\n", letters);
        return -EINVAL;
    }
    return pinned.declare(comp_id, "xyzacb_trsrn_kins");
}

}  // namespace

MW_SWITCHED_MODULE("xyzacb_trsrn", "XYZABC", declare_model);
