// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/modbus/transactions.hh"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::modbus {
namespace {

constexpr const char *INIT = "MB2HAL_INIT";
constexpr int MAX_BITS = 2000, MAX_REGISTERS = 123, MAX_ADDRESS = 65535, MAX_TRANSACTIONS = 1000;
constexpr std::size_t MAX_NAME = 28;

constexpr std::array FUNCTIONS{
    std::pair{"fnct_01_read_coils", Function::READ_COILS},
    std::pair{"fnct_02_read_discrete_inputs", Function::READ_DISCRETE_INPUTS},
    std::pair{"fnct_03_read_holding_registers", Function::READ_HOLDING_REGISTERS},
    std::pair{"fnct_04_read_input_registers", Function::READ_INPUT_REGISTERS},
    std::pair{"fnct_05_write_single_coil", Function::WRITE_SINGLE_COIL},
    std::pair{"fnct_06_write_single_register", Function::WRITE_SINGLE_REGISTER},
    std::pair{"fnct_15_write_multiple_coils", Function::WRITE_MULTIPLE_COILS},
    std::pair{"fnct_16_write_multiple_registers", Function::WRITE_MULTIPLE_REGISTERS},
};
const std::vector<std::string> INIT_KEYS{"INIT_DEBUG", "VERSION", "HAL_MODULE_NAME", "SLOWDOWN",
                                         "TOTAL_TRANSACTIONS"};
const std::vector<std::string> KEYS{"LINK_TYPE",
                                    "TCP_IP",
                                    "TCP_PORT",
                                    "SERIAL_PORT",
                                    "SERIAL_BAUD",
                                    "SERIAL_BITS",
                                    "SERIAL_PARITY",
                                    "SERIAL_STOP",
                                    "SERIAL_DELAY_MS",
                                    "MB_SLAVE_ID",
                                    "FIRST_ELEMENT",
                                    "NELEMENTS",
                                    "PIN_NAMES",
                                    "MB_TX_CODE",
                                    "MB_RESPONSE_TIMEOUT_MS",
                                    "MB_BYTE_TIMEOUT_MS",
                                    "HAL_TX_NAME",
                                    "MAX_UPDATE_RATE",
                                    "DEBUG"};

/// Reads the keys of one section.
class Section {
  public:
    Section(const ini::IniFile &file, std::string name, diagnostics::Sink &sink)
        : file_(file), name_(std::move(name)), sink_(sink) {}

    SourcePlace place() const { return file_.place_of_section(name_); }
    const ini::IniEntry *find(const char *key) const { return file_.find(name_, key); }
    bool has(const char *key) const { return find(key) != nullptr; }
    std::string where(const char *key) const { return "[" + name_ + "]" + key; }

    void text(const char *key, std::string &into) const {
        if (const auto *entry = find(key)) {
            into = entry->value;
        }
    }
    void number(const char *key, int &into, int low, int high) const {
        const auto *entry = find(key);
        if (entry == nullptr) {
            return;
        }
        const auto value = parse_int(entry->value);
        if (!value.has_value() || *value < low || *value > high) {
            sink_.error(fmt::format("{} = {}: a whole number from {} to {} is expected", where(key),
                                    entry->value, low, high),
                        entry->place);
            return;
        }
        into = static_cast<int>(*value);
    }
    void number(const char *key, double &into) const {
        const auto *entry = find(key);
        const auto value = entry != nullptr ? parse_double(entry->value) : std::nullopt;
        if (entry != nullptr && (!value.has_value() || *value < 0)) {
            sink_.error(fmt::format("{} = {}: a number of 0 or more is expected", where(key), entry->value),
                        entry->place);
        } else if (value.has_value()) {
            into = *value;
        }
    }
    void missing(const char *key, const char *why) const {
        sink_.error(where(key) + " is missing: " + why, place());
    }
    void wrong(const char *key, const std::string &expected) const {
        const auto *entry = find(key);
        sink_.error(where(key) + " = " + entry->value + ": " + expected + " is expected", entry->place);
    }
    void report_unknown(const std::vector<std::string> &known) const {
        for (const std::string &key : file_.keys(name_)) {
            if (std::find(known.begin(), known.end(), key) == known.end()) {
                const std::string near = nearest_name(key, known);
                sink_.warning(where(key.c_str()) + " is not known and has no effect",
                              file_.find(name_, key)->place,
                              near.empty() ? "" : "did you mean " + near + "?");
            }
        }
    }

  private:
    const ini::IniFile &file_;
    std::string name_;
    diagnostics::Sink &sink_;
};

void read_serial(const Section &section, Link &link) {
    section.text("SERIAL_PORT", link.device);
    section.number("SERIAL_BAUD", link.baud, 50, 4000000);
    section.number("SERIAL_BITS", link.bits, 5, 8);
    section.number("SERIAL_STOP", link.stop, 1, 2);
    if (const auto *parity = section.find("SERIAL_PARITY")) {
        const std::string word = to_lower(parity->value);
        link.parity = word == "even" ? 'E' : word == "odd" ? 'O' : 'N';
        if (word != "even" && word != "odd" && word != "none") {
            section.wrong("SERIAL_PARITY", "even, odd or none");
        }
    }
    for (const auto &[isMissing, key] : {std::pair{link.device.empty(), "SERIAL_PORT"},
                                         {link.baud == 0, "SERIAL_BAUD"},
                                         {link.bits == 0, "SERIAL_BITS"},
                                         {link.stop == 0, "SERIAL_STOP"}}) {
        if (isMissing && !section.has(key)) {
            section.missing(key, "required for a serial line");
        }
    }
}

/// The link of a section; `before` is that of the section before it.
Link read_link(const Section &section, const Link *before) {
    Link link = before != nullptr ? *before : Link{};
    if (const auto *type = section.find("LINK_TYPE")) {
        const std::string word = to_lower(type->value);
        if (word != "tcp" && word != "serial") {
            section.wrong("LINK_TYPE", "tcp or serial");
        }
        link.is_tcp = word == "tcp";
    } else if (before == nullptr) {
        section.missing("LINK_TYPE", "the first transaction sets the connection to the device");
        return link;
    }
    if (!link.is_tcp) {
        read_serial(section, link);
        return link;
    }
    section.text("TCP_IP", link.address);
    section.number("TCP_PORT", link.port, 1, MAX_ADDRESS);
    if (link.address.empty()) {
        section.missing("TCP_IP", "required for a TCP connection");
    }
    return link;
}

void read_elements(const Section &section, Transaction &one) {
    const auto *names = section.find("PIN_NAMES");
    if (names != nullptr && section.has("NELEMENTS")) {
        section.wrong("PIN_NAMES", "either PIN_NAMES or NELEMENTS");
    }
    one.elements.clear();
    if (names != nullptr) {
        std::string_view rest = names->value;
        while (true) {
            const std::size_t comma = rest.find(',');
            one.elements.emplace_back(trim(rest.substr(0, comma)));
            if (one.elements.back().empty() ||
                one.elements.back().find_first_of(" \t") != std::string::npos) {
                section.wrong("PIN_NAMES", "a list of names without blanks, with commas between");
            }
            if (comma == std::string_view::npos) {
                break;
            }
            rest.remove_prefix(comma + 1);
        }
    } else if (!section.has("NELEMENTS")) {
        section.missing("NELEMENTS", "this key or PIN_NAMES sets the number of elements");
    } else {
        int count = 0;
        section.number("NELEMENTS", count, 1, isOfBits(one.function) ? MAX_BITS : MAX_REGISTERS);
        for (int i = 0; i < count; ++i) {
            one.elements.push_back(fmt::format("{:02}", i));
        }
    }
    const auto count = static_cast<int>(one.elements.size());
    if (count > (isOfBits(one.function) ? MAX_BITS : MAX_REGISTERS) ||
        one.first_element + count - 1 > MAX_ADDRESS) {
        section.wrong("FIRST_ELEMENT", "fewer elements, up to address 65535,");
    }
    if (std::set<std::string>(one.elements.begin(), one.elements.end()).size() != one.elements.size()) {
        section.wrong("PIN_NAMES", "a list without repeated names");
    }
}

void read_function(const Section &section, Transaction &one) {
    const auto *code = section.find("MB_TX_CODE");
    if (code == nullptr) {
        section.missing("MB_TX_CODE", "it is the Modbus function");
        return;
    }
    for (const auto &[name, function] : FUNCTIONS) {
        if (code->value == name) {
            one.function = function;
            return;
        }
    }
    section.wrong("MB_TX_CODE",
                  "fnct_01_read_coils, fnct_02_read_discrete_inputs, fnct_03_read_holding_registers, "
                  "fnct_04_read_input_registers, fnct_05_write_single_coil, fnct_06_write_single_register, "
                  "fnct_15_write_multiple_coils or fnct_16_write_multiple_registers");
}

/// Missing keys have the values of the previous transaction, except name, elements and function.
Transaction read_transaction(const Section &section, const Transaction *before, int number) {
    Transaction one = before != nullptr ? *before : Transaction{};
    one.name = fmt::format("{:02}", number);
    section.text("HAL_TX_NAME", one.name);
    if (one.name.size() > MAX_NAME) {
        section.wrong("HAL_TX_NAME", "a name of at most 28 characters");
    }
    read_function(section, one);
    section.number("MB_SLAVE_ID", one.slave, 0, 247);
    if (before == nullptr && !section.has("MB_SLAVE_ID")) {
        section.missing("MB_SLAVE_ID", "the slave address of the device");
    }
    section.number("FIRST_ELEMENT", one.first_element, 0, MAX_ADDRESS);
    if (!section.has("FIRST_ELEMENT")) {
        section.missing("FIRST_ELEMENT", "the address of the first element");
    }
    read_elements(section, one);
    constexpr int MAX_MS = 3600000;
    section.number("MB_RESPONSE_TIMEOUT_MS", one.response_timeout_ms, 1, MAX_MS);
    section.number("MB_BYTE_TIMEOUT_MS", one.byte_timeout_ms, 0, MAX_MS);
    section.number("SERIAL_DELAY_MS", one.delay_ms, 0, MAX_MS);
    section.number("MAX_UPDATE_RATE", one.max_rate_hz);
    section.number("DEBUG", one.debug, 0, 4);
    section.report_unknown(KEYS);
    return one;
}

}  // namespace

bool isRead(Function function) {
    return function <= Function::READ_INPUT_REGISTERS;
}

bool isOfBits(Function function) {
    return function == Function::READ_COILS || function == Function::READ_DISCRETE_INPUTS ||
           function == Function::WRITE_SINGLE_COIL || function == Function::WRITE_MULTIPLE_COILS;
}

Setup read_setup(const ini::IniFile &file, diagnostics::Sink &sink) {
    Setup setup;
    const Section init(file, INIT, sink);
    init.text("HAL_MODULE_NAME", setup.component);
    init.number("SLOWDOWN", setup.slowdown_s);
    init.report_unknown(INIT_KEYS);
    int total = 0;
    init.number("TOTAL_TRANSACTIONS", total, 1, MAX_TRANSACTIONS);
    if (!init.has("TOTAL_TRANSACTIONS")) {
        init.missing("TOTAL_TRANSACTIONS", "the number of sections [TRANSACTION_00], [TRANSACTION_01]...");
    }
    std::set<std::string> names;
    for (int number = 0; number < total; ++number) {
        const std::string name = fmt::format("TRANSACTION_{:02}", number);
        const Section section(file, name, sink);
        if (!file.hasSection(name)) {
            sink.error("section [" + name + "] is missing: [MB2HAL_INIT]TOTAL_TRANSACTIONS is " +
                           std::to_string(total),
                       init.place());
            continue;
        }
        const Transaction *before = setup.transactions.empty() ? nullptr : &setup.transactions.back();
        const Link link = read_link(section, before != nullptr ? &setup.links[before->link] : nullptr);
        Transaction one = read_transaction(section, before, number);
        auto found = std::find(setup.links.begin(), setup.links.end(), link);
        one.link = static_cast<std::size_t>(found - setup.links.begin());
        if (found == setup.links.end()) {
            setup.links.push_back(link);
        }
        if (!names.insert(one.name).second) {
            sink.error("two transactions have the name " + one.name + ": their pins have the same names",
                       section.place());
        }
        setup.transactions.push_back(std::move(one));
    }
    return setup;
}

}  // namespace mw::modbus
