// SPDX-License-Identifier: GPL-2.0-or-later
// The library that all HostMot2 components use: `hostmot2` sets its options, and the component of a bus
// (hm2_eth, hm2_test) registers its boards, which get pins and the functions NAME.read, .write and
// .read-request.
//
//     // in rtapi_app_main of a bus, with a bus for each board that outlives the component
//     auto board = mw::mesa::register_board({comp_id, "hm2_7i76e.0", &bus, "num_encoders=1"});
//     // in rtapi_app_exit, after hal_exit: then no function of a board runs any more
//     mw::mesa::unregister_boards(comp_id);
#pragma once

#include <string>

#include "drivers/mesa/hostmot2/register_bus.hh"

#define MW_HOSTMOT2_API __attribute__((visibility("default")))

namespace mw::mesa {

/// Options of `loadrt hostmot2`.
struct DriverOptions {
    bool has_idrom_log = false, has_module_log = false, has_pin_log = false, has_use_log = false;
    bool is_named_by_serial_number = false;
    int sserial_baudrate = -1;  ///< baud rate of smart serial ports [bit/s]; -1: that of the firmware
};

/// [while loading]
MW_HOSTMOT2_API void set_driver_options(const DriverOptions &options);
MW_HOSTMOT2_API const DriverOptions &driver_options() noexcept;

struct BoardRequest {
    int comp_id = 0;             ///< component that owns the pins
    std::string name;            ///< name in HAL, such as hm2_7i76e.0
    RegisterBus *bus = nullptr;  ///< must exist until unregister_boards()
    std::string config;          ///< config= of this board
};

/// Reads the firmware of a board and creates its pins and functions: 0, or a negated errno with a message in
/// the log. [while loading]
MW_HOSTMOT2_API int register_board(const BoardRequest &request);
/// Switches the outputs of all boards of a component off and removes the boards. Call it when none of their
/// functions can run. [while unloading]
MW_HOSTMOT2_API void unregister_boards(int comp_id);

}  // namespace mw::mesa
