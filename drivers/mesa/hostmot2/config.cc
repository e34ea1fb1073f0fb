// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/config.hh"

#include <algorithm>
#include <charconv>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace mw::mesa {

namespace {

struct CountToken {
    std::string_view token;
    Gtag gtags[2];  ///< modules that it limits; two entries if two modules have the same token
};

constexpr CountToken COUNT_TOKENS[] = {
    {"num_encoders", {Gtag::ENCODER, Gtag::MUXED_ENCODER}},
    {"num_resolvers", {Gtag::RESOLVER, Gtag::RESOLVER}},
    {"num_pwmgens", {Gtag::PWM, Gtag::PWM}},
    {"num_3pwmgens", {Gtag::THREE_PHASE_PWM, Gtag::THREE_PHASE_PWM}},
    {"num_rcpwmgens", {Gtag::RC_PWM, Gtag::RC_PWM}},
    {"num_stepgens", {Gtag::STEPGEN, Gtag::STEPGEN}},
    {"num_leds", {Gtag::LED, Gtag::LED}},
    {"num_ssrs", {Gtag::SSR, Gtag::SSR}},
    {"num_inmuxs", {Gtag::IN_MUX, Gtag::IN_MUX}},
    {"num_inms", {Gtag::IN_M, Gtag::IN_M}},
    {"num_outms", {Gtag::OUT_M, Gtag::OUT_M}},
    {"num_dplls", {Gtag::DPLL, Gtag::DPLL}},
    {"num_oneshots", {Gtag::ONE_SHOT, Gtag::ONE_SHOT}},
    {"num_periodms", {Gtag::PERIOD_METER, Gtag::PERIOD_METER}},
    {"num_xy2mods", {Gtag::XY2_100, Gtag::XY2_100}},
    {"num_bspis", {Gtag::BSPI, Gtag::BSPI}},
    {"num_uarts", {Gtag::UART_TX, Gtag::UART_RX}},
    {"num_pktuarts", {Gtag::PKT_UART_TX, Gtag::PKT_UART_RX}},
};

/// Tokens besides the counts. N is a number.
constexpr std::string_view OTHER_TOKENS[] = {"firmware",    "stepgen_width", "sserial_port_N", "ssi_chan_N",
                                             "biss_chan_N", "fanuc_chan_N",  "enable_raw"};

std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0U : 1U);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
        }
    }
    return row[b.size()];
}

std::string_view nearest(std::string_view token) {
    std::string_view best;
    std::size_t least = std::numeric_limits<std::size_t>::max();
    const auto consider = [&](std::string_view known) {
        if (const std::size_t d = distance(token, known); d < least) {
            least = d;
            best = known;
        }
    };
    for (const CountToken &count : COUNT_TOKENS) {
        consider(count.token);
    }
    for (const std::string_view known : OTHER_TOKENS) {
        consider(known);
    }
    return best;
}

std::optional<int> integer(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = error == std::errc{} && end == text.data() + text.size();
    return whole ? std::optional(number) : std::nullopt;
}

struct Token {
    std::string_view name, value;
    bool has_value = false;
};

Token split(std::string_view text) {
    const std::size_t at = text.find('=');
    return at == std::string_view::npos ? Token{text, {}, false}
                                        : Token{text.substr(0, at), text.substr(at + 1), true};
}

/// The channel of a token such as ssi_chan_2 with the prefix ssi_chan_.
std::optional<int> channel_of(std::string_view name, std::string_view prefix, int limit) {
    if (!name.starts_with(prefix)) {
        return std::nullopt;
    }
    const auto number = integer(name.substr(prefix.size()));
    return number && *number >= 0 && *number < limit ? number : std::nullopt;
}

Result<> read_count(Config &config, const CountToken &count, const Token &token) {
    const auto number = integer(token.value);
    if (!number || *number < ALL_INSTANCES) {
        return fail(
            fmt::format("config: {}={} is not a number of instances. Use a number from 0, or -1 for all.",
                        token.name, token.value));
    }
    for (const Gtag gtag : count.gtags) {
        config.wanted[gtag] = *number;
    }
    return {};
}

Result<> read_modes(Config &config, int port, const Token &token) {
    constexpr std::string_view MODES = "0123456789xX";
    if (token.value.size() > MAX_CHANNELS || token.value.find_first_not_of(MODES) != std::string_view::npos) {
        return fail(
            fmt::format("config: {}={} is not valid. Use one digit (the mode) or x (not used) for each of "
                        "at most {} channels.",
                        token.name, token.value, MAX_CHANNELS));
    }
    std::string modes(token.value);
    std::ranges::replace(modes, 'X', 'x');
    config.sserial_modes[static_cast<std::size_t>(port)] = modes;
    return {};
}

constexpr int MAX_ABSOLUTE_CHANNELS = 32, MAX_STEPGEN_WIDTH = 8;

Result<> read_token(Config &config, const Token &token) {
    const auto *count = std::ranges::find(COUNT_TOKENS, token.name, &CountToken::token);
    if (count != std::end(COUNT_TOKENS)) {
        return read_count(config, *count, token);
    }
    if (token.name == "firmware" && token.has_value) {
        config.firmware = token.value;
        return {};
    }
    if (token.name == "enable_raw") {
        config.raw_enabled = !token.has_value || token.value != "0";
        return {};
    }
    if (token.name == "stepgen_width") {
        const auto width = integer(token.value);
        if (!width || *width < 1 || *width > MAX_STEPGEN_WIDTH) {
            return fail(fmt::format("config: stepgen_width={} is outside the range 1 to {}.", token.value,
                                    MAX_STEPGEN_WIDTH));
        }
        config.stepgen_width = *width;
        return {};
    }
    if (const auto port = channel_of(token.name, "sserial_port_", MAX_SMART_SERIAL_PORTS)) {
        return read_modes(config, *port, token);
    }
    for (const auto &[prefix, formats] : {std::pair{"ssi_chan_", &config.ssi_formats},
                                          {"biss_chan_", &config.biss_formats},
                                          {"fanuc_chan_", &config.fanuc_formats}}) {
        if (const auto channel = channel_of(token.name, prefix, MAX_ABSOLUTE_CHANNELS)) {
            (*formats)[*channel] = token.value;
            return {};
        }
    }
    return fail(fmt::format("config: unknown token {}. Did you mean {}?", token.name, nearest(token.name)));
}

}  // namespace

const std::map<int, std::string> *Config::formats_of(Gtag gtag) const noexcept {
    switch (gtag) {
    case Gtag::SSI: return &ssi_formats;
    case Gtag::BISS: return &biss_formats;
    case Gtag::FANUC_ABSOLUTE: return &fanuc_formats;
    default: return nullptr;
    }
}

int Config::wanted_of(Gtag gtag) const {
    const auto found = wanted.find(gtag);
    return found == wanted.end() ? ALL_INSTANCES : found->second;
}

Result<Config> parse_config(std::string_view text) {
    constexpr std::string_view BLANKS = " \t\r\n";
    Config config;
    for (std::size_t at = text.find_first_not_of(BLANKS); at != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(BLANKS, at), text.size());
        if (auto done = read_token(config, split(text.substr(at, end - at))); !done) {
            return std::unexpected(done.error());
        }
        at = text.find_first_not_of(BLANKS, end);
    }
    return config;
}

std::string_view token_of(Gtag gtag) noexcept {
    for (const CountToken &count : COUNT_TOKENS) {
        if (count.gtags[0] == gtag || count.gtags[1] == gtag) {
            return count.token;
        }
    }
    return {};
}

}  // namespace mw::mesa
