// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/mtconnect/forms.hh"

#include <chrono>
#include <cmath>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "base/overloaded.hh"
#include "clients/publish/mtconnect/observations.hh"

namespace mw::publish::mtconnect {
namespace {

double scale_of(Form form, double units_per_mm) {
    constexpr double PERCENT = 100, SECONDS_PER_MIN = 60;
    switch (form) {
    case Form::LENGTH: return units_per_mm > 0 ? 1 / units_per_mm : 1;
    case Form::PERCENT: return PERCENT;
    case Form::PER_MIN: return SECONDS_PER_MIN;
    default: return 1;
    }
}

std::string number_text(double number, int digits) {
    if (!std::isfinite(number)) {
        return UNAVAILABLE;
    }
    std::string text = fmt::format("{:.{}f}", number, digits);
    while (text.find('.') != std::string::npos && (text.back() == '0' || text.back() == '.')) {
        const bool isPoint = text.back() == '.';
        text.pop_back();
        if (isPoint) {
            break;
        }
    }
    return text == "-0" ? "0" : text;
}

std::string word_text(Form form, const std::string &word) {
    switch (form) {
    case Form::STOPPED: return word == "ESTOP" ? "TRIGGERED" : "ARMED";
    case Form::MODE: return word == "AUTO" ? "AUTOMATIC" : word == "MDI" ? "MANUAL_DATA_INPUT" : "MANUAL";
    case Form::FILE: return word.substr(word.rfind('/') + 1);
    default: return word;
    }
}

std::string whole_text(Form form, std::int64_t number) {
    constexpr std::int64_t LAST_WHOLE = 6, FIRST_CODE = 53, LAST_CODE = 59;
    switch (form) {
    case Form::DIRECTION: return number > 0 ? "CLOCKWISE" : number < 0 ? "COUNTER_CLOCKWISE" : "NONE";
    case Form::WORK:
        return number <= LAST_WHOLE ? fmt::format("G{}", FIRST_CODE + number)
                                    : fmt::format("G{}.{}", LAST_CODE, number - LAST_WHOLE);
    default: return fmt::format("{}", number);
    }
}

}  // namespace

std::string value_text(const DataItem &item, const Value &value, double units_per_mm) {
    const Form form = item.row == nullptr ? Form::PLAIN : item.row->item.form;
    const bool isAngle = item.units == "DEGREE";
    constexpr int DIGITS = 6;
    return std::visit(Overloaded{[](std::monostate) { return std::string(UNAVAILABLE); },
                                 [](bool on) { return std::string(on ? "true" : "false"); },
                                 [&](std::int64_t number) { return whole_text(form, number); },
                                 [&](std::uint64_t number) { return fmt::format("{}", number); },
                                 [&](double number) {
                                     return number_text(
                                         isAngle ? number : number * scale_of(form, units_per_mm), DIGITS);
                                 },
                                 [&](const std::string &word) { return word_text(form, word); }},
                      value);
}

std::string time_text(TimeMs at) {
    constexpr TimeMs PER_S = 1000;
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(static_cast<std::time_t>(at / PER_S)),
                       at % PER_S);
}

}  // namespace mw::publish::mtconnect
