// SPDX-License-Identifier: GPL-2.0-or-later
// hal_gpio: GPIO lines of the computer by their names, as gpioinfo shows them.
//
//     loadrt hal_gpio inputs=GPIO5,GPIO6 outputs=GPIO20,GPIO21 invert=GPIO20 reset=GPIO21
//
// Function hal_gpio.read sets `NAME-in` and `NAME-in-not`; hal_gpio.write sets the lines to `NAME-out`.
// hal_gpio.reset makes the outputs of reset= inactive `reset_ns` after the write, so that a stepgen makes one
// step in each period. `fault` is true while the kernel does not accept a read or a write.
#include "drivers/gpio/component.hh"

namespace mw::gpio {

namespace {

constexpr const char *MODULE = "hal_gpio";

using Names = char *[MAX_LINES];

/// The module parameters.
struct Wanted {
    const Names &inputs, &outputs, &invert, &reset, &opendrain, &opensource, &biasdisable, &pulldown, &pullup;
};

std::size_t count_of(const Names &names) noexcept {
    std::size_t count = 0;
    while (count < MAX_LINES && names[count] != nullptr && names[count][0] != '\0') {
        ++count;
    }
    return count;
}

Line *find(Lines &lines, const char *name) noexcept {
    for (std::size_t i = 0; i < lines.count; ++i) {
        if (std::strcmp(lines.line[i].name, name) == 0) {
            return &lines.line[i];
        }
    }
    return nullptr;
}

int add(Lines &lines, const Names &names, Direction direction) noexcept {
    for (std::size_t i = 0; i < count_of(names); ++i) {
        if (lines.count == MAX_LINES) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: more than %u lines\n", MODULE,
                            static_cast<unsigned>(MAX_LINES));
            return -EINVAL;
        }
        if (std::strlen(names[i]) >= NAME_SIZE) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: '%s' is too long for the name of a line\n", MODULE, names[i]);
            return -EINVAL;
        }
        if (find(lines, names[i]) != nullptr) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: line '%s' occurs twice in inputs= and outputs=\n", MODULE,
                            names[i]);
            return -EINVAL;
        }
        Line &line = lines.line[lines.count];
        rtapi_snprintf(line.name, sizeof line.name, "%s", names[i]);
        line.direction = direction;
        ++lines.count;
    }
    return 0;
}

/// Lines that a list may contain.
enum class Allowed : std::uint8_t { ALL, OUTPUTS };

/// Calls apply(line) for each line of a list; an error for a name that is not permitted.
template <class Apply>
int apply_to(Lines &lines, const Names &names, const char *list, Allowed allowed, Apply apply) noexcept {
    for (std::size_t i = 0; i < count_of(names); ++i) {
        Line *const line = find(lines, names[i]);
        if (line == nullptr || (allowed == Allowed::OUTPUTS && line->direction != Direction::OUTPUT)) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s=%s: this line is not in %s\n", MODULE, list, names[i],
                            allowed == Allowed::OUTPUTS ? "outputs=" : "inputs= or outputs=");
            return -EINVAL;
        }
        apply(*line);
    }
    return 0;
}

/// Reads the lines from the module parameters. Returns 0, or a negated errno with a message.
int read_lines(const Wanted &wanted, LinePins &pins) noexcept {
    Lines &lines = pins.lines;
    int status = add(lines, wanted.inputs, Direction::INPUT);
    const auto then = [&](int next) { status = status == 0 ? next : status; };
    then(add(lines, wanted.outputs, Direction::OUTPUT));
    if (status == 0 && lines.count == 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: no lines are given, such as inputs=GPIO5 outputs=GPIO20\n",
                        MODULE);
        return -EINVAL;
    }
    then(apply_to(lines, wanted.invert, "invert", Allowed::ALL, [](Line &line) { line.inverted = true; }));
    then(apply_to(lines, wanted.opendrain, "opendrain", Allowed::OUTPUTS,
                  [](Line &line) { line.drive = Drive::OPEN_DRAIN; }));
    then(apply_to(lines, wanted.opensource, "opensource", Allowed::OUTPUTS,
                  [](Line &line) { line.drive = Drive::OPEN_SOURCE; }));
    then(apply_to(lines, wanted.biasdisable, "biasdisable", Allowed::ALL,
                  [](Line &line) { line.bias = Bias::DISABLED; }));
    then(apply_to(lines, wanted.pulldown, "pulldown", Allowed::ALL,
                  [](Line &line) { line.bias = Bias::PULL_DOWN; }));
    then(apply_to(lines, wanted.pullup, "pullup", Allowed::ALL,
                  [](Line &line) { line.bias = Bias::PULL_UP; }));
    then(apply_to(lines, wanted.reset, "reset", Allowed::OUTPUTS, [&](Line &line) {
        pins.resetting |= bit_of(static_cast<std::size_t>(&line - lines.line));
    }));
    return status;
}

}  // namespace

}  // namespace mw::gpio

using mw::gpio::LinePins;
using mw::gpio::MODULE;

constexpr int MAX_NAMES = mw::gpio::MAX_LINES;
static mw::gpio::Names inputs;
RTAPI_MP_ARRAY_STRING(inputs, MAX_NAMES, "input lines")
static mw::gpio::Names outputs;
RTAPI_MP_ARRAY_STRING(outputs, MAX_NAMES, "output lines")
static mw::gpio::Names invert;
RTAPI_MP_ARRAY_STRING(invert, MAX_NAMES, "lines that are active while low")
static mw::gpio::Names reset;
RTAPI_MP_ARRAY_STRING(reset, MAX_NAMES, "outputs that the function reset makes inactive")
static mw::gpio::Names opendrain;
RTAPI_MP_ARRAY_STRING(opendrain, MAX_NAMES, "outputs that are open drain")
static mw::gpio::Names opensource;
RTAPI_MP_ARRAY_STRING(opensource, MAX_NAMES, "outputs that are open source")
static mw::gpio::Names biasdisable;
RTAPI_MP_ARRAY_STRING(biasdisable, MAX_NAMES, "lines without pull-up and pull-down")
static mw::gpio::Names pulldown;
RTAPI_MP_ARRAY_STRING(pulldown, MAX_NAMES, "lines with pull-down")
static mw::gpio::Names pullup;
RTAPI_MP_ARRAY_STRING(pullup, MAX_NAMES, "lines with pull-up")

namespace {

struct Gpio : LinePins {
    int load(int comp_id) noexcept {
        int status = mw::gpio::read_lines(
            {::inputs, outputs, invert, ::reset, opendrain, opensource, biasdisable, pulldown, pullup},
            *this);
        status = status == 0 ? open(MODULE) : status;
        if (status != 0) {
            return status;
        }
        mw::sdk::Declare d(comp_id, MODULE, 0);
        declare(d, [this](std::size_t i) {
            mw::sdk::Name name;
            rtapi_snprintf(name.text, sizeof name.text, "%s", lines.line[i].name);
            return name;
        });
        if (resetting != 0) {
            d.param(reset_ns, "reset_ns");
            d.function<&LinePins::reset>(this, "reset");
        }
        return d.status();
    }
};

}  // namespace

MW_COMPONENT_DEVICE(Gpio, MODULE);
