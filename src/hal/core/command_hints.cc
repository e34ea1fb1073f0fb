// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/command_hints.hh"

#include <algorithm>
#include <array>

namespace mw::hal {
namespace {

struct Absent {
    std::string_view names;  ///< separated by blanks, with a blank at both ends
    std::string_view instead;
};

constexpr Absent ABSENT[] = {
    {" hm2_7i43 hm2_7i90 hm2_pci hm2_rpspi hm2_spi hm2_spix hm2_modbus mesa_uart "
     "mesa_7i65"
     " mesa_pktgyro_test probe_parport hal_ppmc hal_motenc hal_stg hal_vti hal_gm hal_speaker "
     "hal_bb_gpio"
     " hal_ax5214h opto_ac5 pcl720 pluto_step pluto_servo serport setsserial elbpcom ",
     "there is no driver of this board yet; there are drivers of Mesa boards on Ethernet (hm2_eth), parallel "
     "ports "
     "(hal_parport) and GPIO lines (hal_gpio, hal_pi_gpio)"},
    {" hy_vfd hy_gt_vfd pi500_vfd svd-ps_vfd vfs11_vfd wj200_vfd thermistor sendkeys "
     "xhc-hb04 xhc-whb04b-6 xhc-hb04-accels monitor-xhc-hb04 ",
     "the program of an installed LinuxCNC runs on this HAL unmodified: start the machine by script/screens "
     "(millwright-screens)"},
    {" mitsub_vfd pmx485 pmx485-test sim-torch z_level_compensation scorbot-er-3 "
     "qtplasmac_gcode qtplasmac-cfg2prefs qtplasmac-materials qtplasmac-plasmac2qt hal_bridge ",
     "it is a program in Python of LinuxCNC's package, and runs with our modules: start the machine by "
     "script/screens "
     "(millwright-screens)"},
    {" axis axis-remote gmoccapy touchy gscreen qtvcp mdi panelui pyui gremlin_view linuxcnctop debuglevel "
     "teach-in"
     " tklinuxcnc tkemc ngcgui pyngcgui tooledit ",
     "it is a screen of LinuxCNC's package and runs unmodified: start the machine by script/screens "
     "(millwright-screens); ours is DISPLAY = millwright"},
    {" gladevcp gladevcp_demo pyvcp pyvcp_demo hal_manualtoolchange setup_designer ",
     "panels are LinuxCNC's own and run unmodified: start the machine by script/screens "
     "(millwright-screens)"},
    {" 5axisgui genserkins hbmgui hexagui lineardelta maho600gui max5gui melfagui millturngui puma560gui "
     "pumagui"
     " rotarydelta scaragui xyzab-tdr-gui xyzac-trt-gui xyzbc-trt-gui ",
     "it draws a machine and belongs to LinuxCNC's package: start the machine by script/screens "
     "(millwright-screens); "
     "the operator's screen draws the path"},
    {" halshow hal-histogram latency-plot moveoff_gui sim_pin simulate_probe halreport linuxcnc_info ",
     "it is a program in Tcl of LinuxCNC's package and runs by script/screens (millwright-screens); ours are "
     "'halcmd show', 'millwright hal watch', 'millwright hal capture' and latency-histogram"},
    {" stepconf pncconf linuxcncmkdesktop ", "it writes configurations, which run here, but is a program of "
                                             "LinuxCNC's package; 'millwright select' has samples"},
    {" io iov2 milltask halui linuxcncsvr rtapi_app linuxcnc_module_helper tpmod homemod inihal ",
     "it is a part of the machine and is not started separately: use 'millwright start MACHINE.ini'"},
    {" halrmt linuxcnclcd ", "it is not available in Millwright; linuxcncrsh, halcmd and the Python modules "
                             "linuxcnc and hal control a machine from other programs"},
    {" classicladder classicladder_rt ", "ladder logic is not available; use logic components (and2, or2, "
                                         "lut5, estop_latch, timedelay) or your own component (halcompile)"},
    {" homecomp axistest hal_lib tp boss_plc joint_axis_mapper histobinstream latencybinstream "
     "timedeltalatch "
     "xhc_hb04_util ",
     "the module is not installed; halcompile builds it from its .comp file"},
    {" tool_watch tool_mmap_read ",
     "the tool table is in the status: linuxcnc.stat().tool_table, 'millwright ui', linuxcncrsh"},
};

}  // namespace

std::string hint_for_absent(std::string_view name) {
    const std::string word = ' ' + std::string(name) + ' ';
    const auto *const found = std::find_if(std::begin(ABSENT), std::end(ABSENT), [&word](const Absent &one) {
        return one.names.find(word) != std::string_view::npos;
    });
    return found == std::end(ABSENT) ? "" : std::string(found->instead);
}

}  // namespace mw::hal
