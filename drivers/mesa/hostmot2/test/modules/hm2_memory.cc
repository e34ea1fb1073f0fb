// SPDX-License-Identifier: GPL-2.0-or-later
// hm2_memory: a board in memory as a component, for tests of the pins in HAL.
#include "drivers/mesa/hostmot2/hal/driver.hh"
#include "drivers/mesa/hostmot2/test/firmware.hh"
#include "drivers/mesa/hostmot2/test/memory_bus.hh"
#include "hal/sdk/component.hh"

namespace {

char *config = nullptr;
RTAPI_MP_STRING(config, "instances that are used");

int uarts = 0;
RTAPI_MP_INT(uarts, "UARTs that the firmware has besides");

int comp_id = -1;
mw::mesa::test::MemoryBus bus;

}  // namespace

int rtapi_app_main(void) {
    comp_id = hal_init("hm2_memory");
    mw::mesa::Idrom idrom = mw::mesa::test::firmware();
    for (const auto &[gtag, base] :
         {std::pair{mw::mesa::Gtag::UART_TX, 0x6100}, {mw::mesa::Gtag::UART_RX, 0x6500}}) {
        mw::mesa::ModuleDescriptor module;
        module.gtag = gtag;
        module.instances = static_cast<std::uint8_t>(uarts);
        module.base_address = static_cast<std::uint16_t>(base);
        module.instance_stride = 1;
        idrom.modules.push_back(module);
    }
    bus.registers = mw::mesa::test::image_of(idrom);
    bus.connector_names = {"P1", "P2", "P3"};
    bus.registers[0x0D00] = 1;
    const int status =
        mw::mesa::register_board({comp_id, "hm2_7i76e.0", &bus, config == nullptr ? "" : config});
    return mw::sdk::finish(comp_id, status) < 0 ? status : 0;
}

void rtapi_app_exit(void) {
    mw::mesa::unregister_boards(comp_id);
    hal_exit(comp_id);
}
