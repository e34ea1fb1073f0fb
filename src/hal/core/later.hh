// SPDX-License-Identifier: GPL-2.0-or-later
// Drivers of hardware that users of such controllers know and that are not there yet.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace mw::hal {

/// A hint when `name` is such a module or program, else nothing.
inline std::string driver_hint(std::string_view name) {
    constexpr std::array<std::string_view, 34> DRIVERS = {
        "hostmot2",   "hm2_7i43",  "hm2_7i90",          "hm2_eth",     "hm2_pci",
        "hm2_rpspi",  "hm2_spi",   "hm2_spix",          "hm2_modbus",  "hm2_test",
        "mesa_uart",  "mesa_7i65", "mesa_pktgyro_test", "hal_parport", "hal_ppmc",
        "hal_motenc", "hal_stg",   "hal_vti",           "hal_gm",      "hal_speaker",
        "opto_ac5",   "pcl720",    "setsserial",        "mb2hal",      "gs2_vfd",
        "hy_vfd",     "hy_gt_vfd", "mitsub_vfd",        "pi500_vfd",   "svd-ps_vfd",
        "vfdb_vfd",   "vfs11_vfd", "wj200_vfd",         "shuttle"};
    const bool isDriver = std::find(DRIVERS.begin(), DRIVERS.end(), name) != DRIVERS.end();
    return isDriver ? "drivers of hardware come with a later version; this one runs simulated machines" : "";
}

}  // namespace mw::hal
