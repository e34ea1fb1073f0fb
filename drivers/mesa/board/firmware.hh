// SPDX-License-Identifier: GPL-2.0-or-later
// The HostMot2 registers of a board: its modules, its pins, and the hardware connected to them.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/mesa/board/modules/bspi.hh"
#include "drivers/mesa/board/modules/dpll.hh"
#include "drivers/mesa/board/modules/encoder.hh"
#include "drivers/mesa/board/modules/inputs.hh"
#include "drivers/mesa/board/modules/io_ports.hh"
#include "drivers/mesa/board/modules/pwm.hh"
#include "drivers/mesa/board/modules/rc_pwm.hh"
#include "drivers/mesa/board/modules/resolver.hh"
#include "drivers/mesa/board/modules/smart_serial.hh"
#include "drivers/mesa/board/modules/stepgen.hh"
#include "drivers/mesa/board/modules/switches.hh"
#include "drivers/mesa/board/modules/three_phase_pwm.hh"
#include "drivers/mesa/board/modules/uart.hh"
#include "drivers/mesa/board/modules/watchdog.hh"
#include "drivers/mesa/board/physics.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa::board {

/// The registers from power-up on. Time advances only by advance(). [one thread]
class Firmware {
  public:
    /// `physics` is the hardware at the pins; it must outlive the firmware, as motors outlive a reset.
    Firmware(const Idrom &idrom, Physics &physics, std::int64_t power_up_ns);

    /// Advances the time to `to_ns`. Watchdog and DPLL timers act at their own times. A time before the
    /// current one has no effect.
    void advance(std::int64_t to_ns);
    std::uint32_t read(std::uint16_t address);
    void write(std::uint16_t address, std::uint32_t value);
    /// The watchdog bites now, if the firmware has one.
    void bite();

    /// Connects a pin to an external level; empty: to the physics.
    void set_input(unsigned pin, std::optional<bool> level);
    /// The level of an input that is read over the multiplexer of InMux; low at power-up.
    void set_multiplexed_input(unsigned input, bool level);
    bool pin_level(unsigned pin) const { return ports_.level(pin); }
    /// The output state of a pin.
    Drive pin_drive(unsigned pin) const { return ports_.drive(pin); }
    std::int64_t now_ns() const { return now_ns_; }

    /// The modules of these types; nullptr or empty if the firmware has none.
    const StepgenModule *stepgen() const { return stepgen_; }
    const EncoderModule *encoder() const { return encoder_; }
    const WatchdogModule *watchdog() const { return watchdog_; }
    const SsrModule *ssr() const { return ssr_; }
    const LedModule *led() const { return led_; }
    SmartSerialModule *smart_serial() { return serial_; }
    const ThreePhasePwmModule *three_phase_pwm() const { return three_phase_pwm_; }
    const RcPwmModule *rc_pwm() const { return rc_pwm_; }
    BspiModule *bspi() { return bspi_; }
    /// The lines of the UARTs (Gtag::UART_TX) or of the packet UARTs (Gtag::PKT_UART_TX).
    SerialLines &serial_lines(Gtag transmitter) { return *lines_.at(transmitter); }

  private:
    /// The register of a word of the space.
    struct Slot {
        Module *module = nullptr;
        RegisterPlace place;
    };
    Module *add_module(const ModuleDescriptor &descriptor);
    Module *add_inputs(const ModuleDescriptor &descriptor, std::uint32_t clock_hz);
    Module *add_uart(const ModuleDescriptor &descriptor, std::uint32_t clock_hz);
    void set_field_inputs(const RemoteChannel &channel, Remote &remote) const;
    SmartSerialModule *add_serial(const ModuleDescriptor &descriptor);
    template <class T, class... Arguments>
    T *own(Arguments &&...arguments);
    void map(Module &module, const ModuleDescriptor &descriptor);
    void run(std::int64_t to_ns);
    void move(std::int64_t to_ns);
    void sample();
    DriveInputs drive_inputs(const std::vector<std::int64_t> &steps_before) const;
    std::vector<std::int64_t> steps_now() const;
    bool isDriven(Gtag gtag, unsigned unit) const;
    bool outside_level(unsigned pin) const;
    bool module_level(unsigned pin) const;
    std::uint32_t input_levels(const ModuleDescriptor &descriptor) const;
    void latch_all(unsigned timer);

    Idrom idrom_;
    Physics &physics_;
    std::vector<std::uint32_t> identity_;  ///< the registers of the description, by word
    std::vector<Slot> slots_;              ///< slots by word
    std::vector<std::unique_ptr<Module>> modules_;
    std::vector<Module *> pin_modules_;  ///< the module that can use each pin
    std::vector<std::optional<bool>> inputs_;
    std::uint32_t multiplexed_inputs_ = 0;
    std::map<Gtag, std::shared_ptr<SerialLines>> lines_;  ///< lines by type of the transmitter
    IoPorts ports_;
    WatchdogModule *watchdog_ = nullptr;
    StepgenModule *stepgen_ = nullptr;
    EncoderModule *encoder_ = nullptr;
    PwmModule *pwm_ = nullptr;
    DpllModule *dpll_ = nullptr;
    SsrModule *ssr_ = nullptr;
    LedModule *led_ = nullptr;
    SmartSerialModule *serial_ = nullptr;
    ThreePhasePwmModule *three_phase_pwm_ = nullptr;
    RcPwmModule *rc_pwm_ = nullptr;
    BspiModule *bspi_ = nullptr;
    std::int64_t now_ns_;
};

}  // namespace mw::mesa::board
