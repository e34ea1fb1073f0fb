// SPDX-License-Identifier: GPL-2.0-or-later
// hostmot2: options of all HostMot2 boards. It is loaded before the component of a bus.
#include <cerrno>

#include "drivers/mesa/hostmot2/hal/driver.hh"
#include "hal/sdk/component.hh"
#include "rtapi.h"

namespace {

int debug_idrom = 0;
int debug_module_descriptors = 0;
int debug_pin_descriptors = 0;
int debug_modules = 0;
int use_serial_numbers = 0;
int sserial_baudrate = -1;
RTAPI_MP_INT(debug_idrom, "1: log the header of the description of the firmware");
RTAPI_MP_INT(debug_module_descriptors, "1: log the modules of the firmware");
RTAPI_MP_INT(debug_pin_descriptors, "1: log the pins of the firmware");
RTAPI_MP_INT(debug_modules, "1: log the modules that are used");
RTAPI_MP_INT(use_serial_numbers, "1: name the pins of smart serial cards by the serial number of the card");
RTAPI_MP_INT(sserial_baudrate, "baud rate of smart serial ports; -1: that of the firmware");

int comp_id = -1;

}  // namespace

int rtapi_app_main(void) {
    comp_id = hal_init("hostmot2");
    if (comp_id < 0) {
        return comp_id;
    }
    mw::mesa::DriverOptions options;
    options.has_idrom_log = debug_idrom != 0;
    options.has_module_log = debug_module_descriptors != 0;
    options.has_pin_log = debug_pin_descriptors != 0;
    options.has_use_log = debug_modules != 0;
    options.is_named_by_serial_number = use_serial_numbers != 0;
    options.sserial_baudrate = sserial_baudrate;
    mw::mesa::set_driver_options(options);
    if (sserial_baudrate != -1 && sserial_baudrate <= 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "hostmot2: sserial_baudrate=%d is no baud rate, such as 2500000\n",
                        sserial_baudrate);
        hal_exit(comp_id);
        return -EINVAL;
    }
    return mw::sdk::finish(comp_id, 0) < 0 ? -1 : 0;
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);
}
