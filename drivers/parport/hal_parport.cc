// SPDX-License-Identifier: GPL-2.0-or-later
// hal_parport: the pins of PC parallel ports.
//
//     loadrt hal_parport cfg="0x378 out 0x278 in"
//
// Function parport.N.read sets `pin-NN-in` and `pin-NN-in-not`; parport.N.write gives the connector the
// states of `pin-NN-out`, inverted while the parameter `pin-NN-out-invert` is true. parport.N.reset waits
// until `reset-time` [ns] after the write and resets data pins whose parameter `pin-NN-out-reset` is true to
// their inactive state, so that a stepgen with stepspace 0 makes one step in each period. parport.read-all
// and parport.write-all serve all ports. backend= selects the access to the registers: auto, direct, device
// (/dev/parportN) or simulated. Under the virtual clock ports are simulated. A simulated port has
// `pin-NN-in-fake` (bit in) for the levels of its inputs and `pin-NN-out-fake` (bit out) for those of its
// outputs.
#include <cstdlib>
#include <cstring>

#include "drivers/parport/access.hh"
#include "drivers/parport/config.hh"
#include "drivers/parport/port.hh"
#include "hal/sdk/canonical.hh"
#include "millwright_ext.h"

namespace mw::parport {

using namespace sdk;

namespace {

constexpr const char *MODULE = "hal_parport";
/// Below this value, numbers of detected ports; from it on, addresses.
constexpr std::uint16_t FIRST_ADDRESS = 16;

enum class Backend : std::uint8_t { AUTO, DIRECT, DEVICE, SIMULATED };

/// A port with its pins.
struct PortPins {
    Port port;
    DirectAccess direct;
    DeviceAccess device;
    SimulatedAccess simulated;
    PortAccess *access = nullptr;
    DigitalOut out[MAX_LINES];
    ParamRw<bool> out_reset[MAX_LINES];
    Out<bool> out_fake[MAX_LINES];
    DigitalIn in[MAX_LINES];
    In<bool> in_fake[MAX_LINES];
    ParamRw<std::uint32_t> reset_time;
    long long written_ns = 0;

    int open(const PortConfig &config, Backend wanted) noexcept {
        const bool numbered = config.address < FIRST_ADDRESS;
        int status = -ENODEV;
        if (wanted == Backend::SIMULATED) {
            access = &simulated;
            status = 0;
        }
        if (wanted == Backend::AUTO || wanted == Backend::DIRECT) {
            status = direct.open(MODULE, config.address);
            access = &direct;
        }
        if (wanted == Backend::DEVICE && !numbered) {
            rtapi_print_msg(
                RTAPI_MSG_ERR,
                "%s: backend=device needs the number of the port, such as cfg=\"0 out\", not 0x%x\n", MODULE,
                config.address);
        }
        if (status != 0 && wanted != Backend::DIRECT && numbered) {
            status = device.open(MODULE, config.address);
            access = &device;
        }
        if (status != 0) {
            access = nullptr;
        }
        return status;
    }

    void declare(Declare &d) noexcept {
        const auto outputs = port.outputs().all();
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            out[i].declare(d, numbered("pin-%02d-", outputs[i].pin).text, {.invert = "out-invert"});
            if (outputs[i].reg == Register::DATA) {
                d.param_at(out_reset[i], "pin-%02d-out-reset", outputs[i].pin);
            }
            if (access == &simulated) {
                d.pin_at(out_fake[i], "pin-%02d-out-fake", outputs[i].pin);
            }
        }
        const auto inputs = port.inputs().all();
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            in[i].declare(d, numbered("pin-%02d-", inputs[i].pin).text);
            if (access == &simulated) {
                d.pin_at(in_fake[i], "pin-%02d-in-fake", inputs[i].pin);
            }
        }
        if (port.outputs().line[0].reg == Register::DATA) {
            d.param(reset_time, "reset-time");
            d.function<&PortPins::reset>(this, "reset");
        }
        d.function<&PortPins::read>(this, "read");
        d.function<&PortPins::write>(this, "write");
    }

    void read() noexcept {
        const auto inputs = port.inputs().all();
        if (access == &simulated) {
            for (std::size_t i = 0; i < inputs.size(); ++i) {
                simulated.set_level(inputs[i], in_fake[i]);
            }
        }
        const Levels levels = port.read();
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            in[i].read((levels & (Levels{1} << i)) != 0);
        }
    }

    void write() noexcept {
        Levels levels = 0;
        for (std::size_t i = 0; i < port.outputs().count; ++i) {
            levels |= out[i].write() ? Levels{1} << i : 0U;
        }
        port.write(levels);
        written_ns = rtapi_get_time();
        show_levels();
    }

    void reset(long period_ns) noexcept {
        Levels mask = 0, levels = 0;
        for (std::size_t i = 0; i < port.outputs().count && port.outputs().line[i].reg == Register::DATA;
             ++i) {
            mask |= out_reset[i] ? Levels{1} << i : 0U;
            levels |= out[i].invert ? Levels{1} << i : 0U;
        }
        if (mask == 0) {
            return;
        }
        delay_after(written_ns, reset_time, period_ns);
        port.reset(mask, levels);
        show_levels();
    }

    /// Switches all outputs off.
    void end() noexcept {
        if (access == nullptr) {
            return;
        }
        port.write(inactive());
        access->release();
    }

    void show_levels() noexcept {
        if (access == &simulated) {
            for (std::size_t i = 0; i < port.outputs().count; ++i) {
                out_fake[i] = simulated.level(port.outputs().line[i]);
            }
        }
    }
    Levels inactive() const noexcept {
        Levels levels = 0;
        for (std::size_t i = 0; i < port.outputs().count; ++i) {
            levels |= out[i].invert ? Levels{1} << i : 0U;
        }
        return levels;
    }
};

char *cfg = nullptr;
RTAPI_MP_STRING(cfg, "addresses and types of the ports")
char *backend = nullptr;
RTAPI_MP_STRING(backend, "auto, direct, device or simulated")

bool find_backend(const char *name, Backend &found) noexcept {
    constexpr const char *NAMES[] = {"auto", "direct", "device", "simulated"};
    for (std::size_t i = 0; i < std::size(NAMES); ++i) {
        if (std::strcmp(name, NAMES[i]) == 0) {
            found = static_cast<Backend>(i);
            return true;
        }
    }
    return false;
}

struct Ports {
    PortPins *port[MAX_PORTS] = {};
    int count = 0;

    int load(int comp_id) noexcept {
        const Config config = read_config(cfg == nullptr ? "" : cfg);
        if (config.problem != nullptr) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: cfg=: %s%s%s\n", MODULE, config.token.data(),
                            config.token[0] != '\0' ? " " : "", config.problem);
            return -EINVAL;
        }
        const char *const name = backend != nullptr ? backend : std::getenv("MILLWRIGHT_PARPORT");
        Backend wanted = Backend::AUTO;
        if (name != nullptr && !find_backend(name, wanted)) {
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s: backend=%s: auto, direct, device and simulated are possible\n", MODULE,
                            name);
            return -EINVAL;
        }
        if (mw_ext_is_virtual() != 0) {
            wanted = Backend::SIMULATED;  // another process may drive a machine with this port
        }
        for (int i = 0; i < config.count; ++i) {
            if (const int status = add(comp_id, config.port[static_cast<std::size_t>(i)], wanted);
                status < 0) {
                return status;
            }
        }
        Declare all(comp_id, "parport", 0);
        all.function<&Ports::read_all>(this, "read-all");
        all.function<&Ports::write_all>(this, "write-all");
        return all.status();
    }
    int add(int comp_id, const PortConfig &config, Backend wanted) noexcept {
        PortPins *const one = make<PortPins>();
        if (one == nullptr) {
            return -ENOMEM;
        }
        if (const int status = one->open(config, wanted); status < 0) {
            return status;
        }
        port[count] = one;
        one->port.begin(*one->access, config.mode, 0);
        Declare declare(comp_id, numbered("parport.%d", count).text, count);
        ++count;
        one->declare(declare);
        return declare.status();
    }
    void read_all() noexcept {
        for (int i = 0; i < count; ++i) {
            port[i]->read();
        }
    }
    void write_all() noexcept {
        for (int i = 0; i < count; ++i) {
            port[i]->write();
        }
    }
    void end() noexcept {
        for (int i = 0; i < count; ++i) {
            port[i]->end();
        }
    }
};

}  // namespace

}  // namespace mw::parport

MW_COMPONENT_DEVICE(mw::parport::Ports, mw::parport::MODULE);
