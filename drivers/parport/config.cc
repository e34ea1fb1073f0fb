// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/parport/config.hh"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace mw::parport {

namespace {

constexpr const char *SEPARATORS = " _\t\n";

bool isDigit(char c) noexcept {
    return c >= '0' && c <= '9';
}

/// Finds the type with this first letter; false if there is none.
bool find_mode(char letter, Mode &mode) noexcept {
    constexpr struct {
        char letter;
        Mode mode;
    } TYPES[] = {{'o', Mode::OUT}, {'i', Mode::IN}, {'x', Mode::CONTROL_IN}, {'e', Mode::EPP}};
    const auto *type = std::find_if(std::begin(TYPES), std::end(TYPES),
                                    [&](const auto &one) { return one.letter == (letter | 0x20); });
    if (type == std::end(TYPES)) {
        return false;
    }
    mode = type->mode;
    return true;
}

const char *add_port(Config &config, const char *word) noexcept {
    constexpr unsigned long LAST_ADDRESS = 0xFFF8;
    if (config.count == MAX_PORTS) {
        return "eight ports are possible";
    }
    char *end = nullptr;
    const unsigned long address = std::strtoul(word, &end, 0);
    if (*end != '\0') {
        return "is no address of a port, such as 0x378, and no number of a port, such as 0";
    }
    if (address > LAST_ADDRESS) {
        return "is outside the addresses of ports, 0x10 to 0xfff8";
    }
    PortConfig &port = config.port[static_cast<std::size_t>(config.count)];
    port.address = static_cast<std::uint16_t>(address);
    const auto before = std::span(config.port).first(static_cast<std::size_t>(config.count));
    if (std::any_of(before.begin(), before.end(),
                    [&](const PortConfig &one) { return one.address == port.address; })) {
        return "occurs twice";
    }
    ++config.count;
    return nullptr;
}

}  // namespace

Config read_config(const char *text) noexcept {
    Config config;
    bool typed = true;  // the last port has a type, or there is no port
    for (text += std::strspn(text, SEPARATORS); *text != '\0' && config.problem == nullptr;
         text += std::strspn(text, SEPARATORS)) {
        const std::size_t length = std::strcspn(text, SEPARATORS);
        const std::size_t kept = std::min(length, config.token.size() - 1);
        config.token.fill('\0');
        std::memcpy(config.token.data(), text, kept);
        text += length;
        if (kept < length) {
            config.problem = "is too long for an address or a type";
        } else if (isDigit(config.token[0])) {
            config.problem = add_port(config, config.token.data());
            typed = false;
        } else if (typed) {
            config.problem = "must follow the address of a port";
        } else if (!find_mode(config.token[0],
                              config.port[static_cast<std::size_t>(config.count - 1)].mode)) {
            config.problem = "is no type of a port: out, in, x and epp are possible";
        } else {
            typed = true;
        }
    }
    if (config.problem == nullptr && config.count == 0) {
        config.token.fill('\0');
        config.problem = "no port is given, such as cfg=\"0x378 out\"";
    }
    return config;
}

}  // namespace mw::parport
