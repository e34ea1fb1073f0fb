// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/model.hh"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "drivers/mesa/board/table_file.hh"

namespace mw::mesa::board {

namespace {

struct ModuleName {
    std::string_view name;
    Gtag gtag;
};

constexpr ModuleName MODULES[] = {
    {"watchdog", Gtag::WATCHDOG},
    {"ioport", Gtag::IO_PORT},
    {"encoder", Gtag::ENCODER},
    {"muxed-encoder", Gtag::MUXED_ENCODER},
    {"mux-select", Gtag::MUX_SELECT},
    {"stepgen", Gtag::STEPGEN},
    {"pwm", Gtag::PWM},
    {"three-phase-pwm", Gtag::THREE_PHASE_PWM},
    {"dpll", Gtag::DPLL},
    {"led", Gtag::LED},
    {"smart-serial", Gtag::SMART_SERIAL},
    {"ssr", Gtag::SSR},
    {"inmux", Gtag::IN_MUX},
    {"inm", Gtag::IN_M},
    {"outm", Gtag::OUT_M},
    {"resolver", Gtag::RESOLVER},
    {"rc-pwm", Gtag::RC_PWM},
    {"uart-tx", Gtag::UART_TX},
    {"uart-rx", Gtag::UART_RX},
    {"bspi", Gtag::BSPI},
    {"pkt-uart-tx", Gtag::PKT_UART_TX},
    {"pkt-uart-rx", Gtag::PKT_UART_RX},
};

constexpr std::int64_t MAX_U32 = 0xFFFFFFFF;

/// Names, ports and clocks: the line "board".
void read_board(TableLine &line, Model &model) {
    IdromHeader &header = model.idrom.header;
    const auto number = [&](std::string_view key, std::int64_t fallback, std::int64_t high = MAX_U32) {
        return static_cast<std::uint32_t>(line.whole(key, 0, high, fallback));
    };
    model.card_name = line.text("card");
    header.board_name = line.text("name");
    if (model.card_name.size() > 16) {
        line.reject("card", fmt::format("The card name '{}' has more than 16 characters.", model.card_name));
    }
    if (header.board_name.size() != 8) {
        line.reject("name",
                    fmt::format("The board name '{}' does not have 8 characters.", header.board_name));
    }
    model.flash_id = static_cast<std::uint8_t>(line.whole("flash_id", 0x13, 0x15, 0x14));
    model.firmware_version = static_cast<std::uint16_t>(number("firmware_version", 15, 0xFFFF));
    header.type = number("idrom_type", 3);
    header.modules_offset = 0x40;
    header.pins_offset = header.type == 2 ? 0x200 : 0x1C0;
    header.io_ports = static_cast<std::uint32_t>(line.whole("ports", 1, 8));
    header.port_width = static_cast<std::uint32_t>(line.whole("port_width", 1, 32));
    header.io_width = header.io_ports * header.port_width;
    header.fpga_size = number("fpga_size", 9);
    header.fpga_pins = number("fpga_pins", 256);
    header.clock_low_hz = number("clock_low_hz", 100'000'000);
    header.clock_high_hz = number("clock_high_hz", 200'000'000);
    header.instance_strides[0] = 4;
    header.instance_strides[1] = static_cast<std::uint32_t>(line.whole("instance_stride1", 4, 0x100, 0x40));
    header.register_strides[0] = header.register_strides[1] = 0x100;
    model.idrom.pins.assign(std::min<std::uint32_t>(header.io_width, MAX_PINS), {});
}

/// A module without a name in the table is gtag-N.
constexpr std::string_view GTAG = "gtag-";

std::string name_of(Gtag gtag) {
    const auto *one = std::ranges::find(MODULES, gtag, &ModuleName::gtag);
    return one != std::end(MODULES) ? std::string(one->name)
                                    : fmt::format("{}{}", GTAG, static_cast<int>(gtag));
}

std::optional<Gtag> find_module(TableLine &line, std::string_view key, const std::string &name) {
    const auto *one = std::ranges::find(MODULES, name, &ModuleName::name);
    if (one != std::end(MODULES)) {
        return one->gtag;
    }
    const auto number = name.starts_with(GTAG) ? parse_uint(name.substr(GTAG.size())) : std::nullopt;
    if (number.has_value() && *number > 0 && *number <= 255) {
        return static_cast<Gtag>(*number);
    }
    std::vector<std::string> names;
    for (const ModuleName &module : MODULES) {
        names.emplace_back(module.name);
    }
    const std::string near = nearest_name(name, names);
    line.reject(key, fmt::format("Unknown module '{}'.{}", name,
                                 near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
    return {};
}

void read_module(TableLine &line, Model &model) {
    const auto gtag = find_module(line, "", line.name());
    const auto byte = [&](std::string_view key, std::int64_t fallback) {
        return static_cast<std::uint8_t>(line.whole(key, 0, 255, fallback));
    };
    ModuleDescriptor module;
    module.gtag = gtag.value_or(Gtag::NONE);
    module.base_address = static_cast<std::uint16_t>(line.whole("base", 0, 0xFFFF));
    module.registers = static_cast<std::uint8_t>(line.whole("registers", 1, 255));
    module.version = byte("version", 0);
    module.instances = byte("instances", 1);
    module.fast_clock = line.choice("clock", {"low", "high"}, 0) == 1;
    module.instance_stride = static_cast<std::uint8_t>(line.whole("instance_stride", 0, 1, 0));
    module.register_stride = static_cast<std::uint8_t>(line.whole("register_stride", 0, 1, 0));
    module.per_instance = static_cast<std::uint32_t>(line.whole("per_instance", 0, MAX_U32, 0));
    if (model.idrom.modules.size() >= static_cast<std::size_t>(MAX_MODULES)) {
        line.reject("", fmt::format("A board has at most {} modules.", MAX_MODULES));
    }
    model.idrom.modules.push_back(module);
}

void read_pin(TableLine &line, Model &model) {
    const auto number = parse_int(line.name());
    const auto pins = static_cast<std::int64_t>(model.idrom.pins.size());
    if (!number.has_value() || *number < 0 || *number >= pins) {
        line.reject("", fmt::format("'{}' is not a pin from 0 to {}.", line.name(), pins - 1));
    }
    const std::string module = line.text("module");
    const auto gtag = find_module(line, "module", module);
    const auto unit = static_cast<std::uint8_t>(line.whole("unit", 0, 255, 0));
    const auto secondary = static_cast<std::uint8_t>(line.whole("function", 1, 255));
    if (gtag.has_value() &&
        std::ranges::find(model.idrom.modules, *gtag, &ModuleDescriptor::gtag) == model.idrom.modules.end()) {
        line.reject("module", fmt::format("The board has no module '{}'.", module));
    }
    if (line.finish().has_value()) {
        PinDescriptor &pin = model.idrom.pins[static_cast<std::size_t>(*number)];
        if (pin.secondary != Gtag::NONE) {
            line.reject("", fmt::format("Pin {} is declared twice.", *number));
        }
        pin = {.secondary_pin = secondary, .secondary = *gtag, .unit = unit};
    }
}

/// Checks the parts of the description that a driver checks, so that no model is accepted that a driver would
/// reject.
Result<> check(const Model &model, const std::string &file) {
    const auto encoded = encode_idrom(model.idrom);
    if (!encoded.has_value()) {
        return fail(encoded.error().message, {file, 0, 0});
    }
    const auto decoded =
        decode_idrom([&](std::uint16_t address, int count) -> Result<std::vector<std::uint32_t>> {
            std::vector<std::uint32_t> words(static_cast<std::size_t>(count), 0);
            for (const RegisterValue &one : *encoded) {
                const int index = (one.address - address) / 4;
                if (one.address >= address && index < count) {
                    words[static_cast<std::size_t>(index)] = one.value;
                }
            }
            return words;
        });
    if (!decoded.has_value()) {
        return fail(decoded.error().message, {file, 0, 0});
    }
    return {};
}

}  // namespace

Result<Model> parse_model(std::string_view text, const std::string &file) {
    auto lines = parse_table(text, file);
    if (!lines.has_value()) {
        return std::unexpected(lines.error());
    }
    Model model;
    bool has_board = false;
    for (TableLine &line : *lines) {
        const std::string &type = line.type();
        if (type == "board" ? has_board : !has_board) {
            return fail(has_board ? "A model has one line 'board'." : "The first line of a model is 'board'.",
                        line.place());
        }
        if (type == "board") {
            read_board(line, model);
            has_board = true;
        } else if (type == "module") {
            read_module(line, model);
        } else if (type == "pin") {
            read_pin(line, model);
        } else {
            return fail(fmt::format("Unknown line '{}', expected board, module or pin.", type), line.place());
        }
        if (auto finished = line.finish(); !finished.has_value()) {
            return std::unexpected(finished.error());
        }
    }
    if (!has_board) {
        return fail("The model is empty: the line 'board' is missing.", {file, 1, 1});
    }
    if (auto checked = check(model, file); !checked.has_value()) {
        return std::unexpected(checked.error());
    }
    return model;
}

Result<std::string> write_model(const Model &model) {
    const IdromHeader &header = model.idrom.header;
    std::string text =
        fmt::format("# The firmware of a board, for virtual boards and hm2-board --model FILE.\n"
                    "board card={} name={} ports={} port_width={} clock_low_hz={} clock_high_hz={} "
                    "idrom_type={} fpga_size={} "
                    "fpga_pins={} instance_stride1={:#x} firmware_version={} flash_id={:#x}\n",
                    model.card_name, header.board_name, header.io_ports, header.port_width,
                    header.clock_low_hz, header.clock_high_hz, header.type, header.fpga_size,
                    header.fpga_pins, header.instance_strides[1], model.firmware_version, model.flash_id);
    for (const ModuleDescriptor &module : model.idrom.modules) {
        text += fmt::format(
            "module {} version={} instances={} base={:#x} registers={} clock={} register_stride={} "
            "instance_stride={} per_instance={:#x}\n",
            name_of(module.gtag), module.version, module.instances, module.base_address, module.registers,
            module.fast_clock ? "high" : "low", module.register_stride, module.instance_stride,
            module.per_instance);
    }
    int number = 0;
    for (const PinDescriptor &pin : model.idrom.pins) {
        if (pin.secondary != Gtag::NONE) {
            text += fmt::format("pin {} module={} unit={} function={:#x}\n", number, name_of(pin.secondary),
                                pin.unit, pin.secondary_pin);
        }
        ++number;
    }
    const auto again = parse_model(text, "firmware");
    if (!again) {
        return fail(fmt::format("the firmware of the board {} cannot be written as a model: {}",
                                model.card_name, again.error().str()));
    }
    Idrom idrom = model.idrom;
    // the position of the lists is not compared
    idrom.header.modules_offset = again->idrom.header.modules_offset;
    idrom.header.pins_offset = again->idrom.header.pins_offset;
    if (again->idrom != idrom) {
        return fail(
            fmt::format("the firmware of the board {} has strides or pins that a model cannot describe",
                        model.card_name));
    }
    return text;
}

Result<Model> load_model(const std::string &name) {
    if (name.find_first_of("/.") != std::string::npos) {
        const auto text = read_file(name);
        return text.has_value() ? parse_model(*text, name) : std::unexpected(text.error());
    }
    const auto models = built_in_models();
    const auto one = std::ranges::find(models, name, &BuiltInModel::name);
    if (one != models.end()) {
        return parse_model(one->text, name + ".txt");
    }
    std::vector<std::string_view> names;
    for (const BuiltInModel &model : models) {
        names.push_back(model.name);
    }
    return fail(fmt::format("Unknown model '{}'. Built in are {}; a file is given by its path.", name,
                            fmt::join(names, ", ")));
}

}  // namespace mw::mesa::board
