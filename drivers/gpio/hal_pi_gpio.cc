// SPDX-License-Identifier: GPL-2.0-or-later
// hal_pi_gpio: the GPIO lines of a Raspberry Pi under the numbers of its 40-pin header.
//
//     loadrt hal_pi_gpio dir=0x3 exclude=0x3fffffc
//
// Bit n of the masks is GPIO n+2. dir: 1 is an output; exclude: 1 means that the line is not used. Without
// them all lines are outputs. Function hal_pi_gpio.read sets `pin-NN-in` and `pin-NN-in-not`;
// hal_pi_gpio.write sets the lines to `pin-NN-out`. `fault` is true while the kernel does not accept a read
// or a write.
#include "drivers/gpio/component.hh"

namespace mw::gpio {

namespace {

constexpr const char *MODULE = "hal_pi_gpio";
constexpr std::size_t NUM_LINES = 26;
constexpr unsigned ALL = (1U << NUM_LINES) - 1;
constexpr unsigned FIRST_GPIO = 2;
/// Pin of the header of GPIO 2, 3, ... 27.
constexpr std::uint8_t HEADER_PIN[NUM_LINES] = {3,  5,  7,  29, 31, 26, 24, 21, 19, 23, 32, 33, 8,
                                                10, 36, 11, 12, 35, 38, 40, 15, 16, 18, 22, 37, 13};

/// Parses a mask from loadrt; false, with a message, when it is not a number or has too many bits.
bool read_mask(const char *name, const char *text, unsigned fallback, unsigned &mask) noexcept {
    mask = fallback;
    if (text == nullptr) {
        return true;
    }
    char *end = nullptr;
    const unsigned long value = std::strtoul(text, &end, 0);
    if (end == text || *end != '\0' || value > ALL) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s=%s is no mask of %u lines, 0 to 0x%x\n", MODULE, name, text,
                        static_cast<unsigned>(NUM_LINES), ALL);
        return false;
    }
    mask = static_cast<unsigned>(value);
    return true;
}

}  // namespace

}  // namespace mw::gpio

using mw::gpio::LinePins;
using mw::gpio::MODULE;

static char *dir = nullptr;
RTAPI_MP_STRING(dir, "mask of the outputs")
static char *exclude = nullptr;
RTAPI_MP_STRING(exclude, "mask of the lines that are left alone")

static std::uint8_t header_pin[mw::gpio::NUM_LINES];

namespace {

struct Gpio : LinePins {
    int load(int comp_id) noexcept {
        unsigned outputs = 0, excluded = 0;
        if (!mw::gpio::read_mask("dir", dir, mw::gpio::ALL, outputs) ||
            !mw::gpio::read_mask("exclude", exclude, 0, excluded)) {
            return -EINVAL;
        }
        for (unsigned i = 0; i < mw::gpio::NUM_LINES; ++i) {
            if ((excluded & (1U << i)) != 0) {
                continue;
            }
            mw::gpio::Line &line = lines.line[lines.count];
            rtapi_snprintf(line.name, sizeof line.name, "GPIO%u", i + mw::gpio::FIRST_GPIO);
            line.direction =
                (outputs & (1U << i)) != 0 ? mw::gpio::Direction::OUTPUT : mw::gpio::Direction::INPUT;
            header_pin[lines.count] = mw::gpio::HEADER_PIN[i];
            ++lines.count;
        }
        if (lines.count == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: exclude= leaves no line\n", MODULE);
            return -EINVAL;
        }
        if (const int status = open(MODULE); status != 0) {
            return status;
        }
        mw::sdk::Declare d(comp_id, MODULE, 0);
        declare(d, [](std::size_t i) { return mw::sdk::numbered("pin-%02d", header_pin[i]); });
        return d.status();
    }
};

}  // namespace

MW_COMPONENT_DEVICE(Gpio, MODULE);
