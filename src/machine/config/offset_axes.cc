// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/offset_axes.hh"

#include "kinematics/corexy.hh"
#include "kinematics/matrix.hh"
#include "kinematics/rotate.hh"
#include "motion/interface/parameters.hh"

namespace mw::machine {

kinematics::LinearJoints linear_joints(const std::vector<std::string> &kinematics) {
    const std::string module = kinematics.empty() ? "" : kinematics.front();
    return module == "corexykins"   ? kinematics::CoreXy().linear()
           : module == "rotatekins" ? kinematics::Rotate().linear()
           : module == "matrixkins" ? kinematics::Matrix().linear()
                                    : kinematics::LinearJoints{};
}

void check_offset(ini::IniReader &ini, const std::string &section, int axis, MachineConfig &machine) {
    using motion::Parameter;
    const ini::IniKey ratio = ini_key(Parameter::AXIS_OFFSET_RATIO);
    const bool linear = (machine.axis_map.linear.axes >> axis & 1U) != 0;
    if (machine.isTrivial || linear || !(ini.real(ratio, section) > 0)) {
        return;
    }
    ini.sink().warning('[' + section +
                           "]OFFSET_AV_RATIO has no effect: external offsets are for machines whose joints "
                           "are axes (trivkins) and for axes that move joints in proportion (corexykins, "
                           "matrixkins; rotatekins: all but X, Y and C)",
                       ini.find(ratio, section)->place);
    std::erase_if(machine.parameters, [axis](const motion::SetParameter &p) {
        return p.parameter == static_cast<std::uint16_t>(Parameter::AXIS_OFFSET_RATIO) && p.index == axis;
    });
}

}  // namespace mw::machine
