// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/object_file.hh"

#include <elf.h>

#include <cstring>
#include <optional>

#include <fmt/core.h>

namespace mw::halcompile {
namespace {

template <class T>
std::optional<T> read_at(std::string_view bytes, std::size_t offset) {
    T value;
    if (offset > bytes.size() || sizeof value > bytes.size() - offset) {
        return {};
    }
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

std::string_view part(std::string_view bytes, std::size_t offset, std::size_t size) {
    return offset > bytes.size() || size > bytes.size() - offset ? std::string_view()
                                                                 : bytes.substr(offset, size);
}

std::string text_at(std::string_view table, std::size_t offset) {
    if (offset >= table.size()) {
        return {};
    }
    const std::string_view rest = table.substr(offset);
    return std::string(rest.substr(0, rest.find('\0')));
}

void take_exports(std::string_view section, ObjectFacts &facts) {
    for (std::size_t at = 0; at < section.size();) {
        const std::string name = text_at(section, at);
        at += name.size() + 1;
        if (!name.empty()) {
            facts.exported.push_back(name);
        }
    }
}

void take_symbols(std::string_view symbols, std::string_view names, ObjectFacts &facts) {
    for (std::size_t at = 0; at + sizeof(Elf64_Sym) <= symbols.size(); at += sizeof(Elf64_Sym)) {
        const auto symbol = read_at<Elf64_Sym>(symbols, at);
        const unsigned bind = ELF64_ST_BIND(symbol->st_info);
        const std::string name = text_at(names, symbol->st_name);
        if (bind != STB_LOCAL && !name.empty()) {
            (symbol->st_shndx == SHN_UNDEF ? facts.undefined : facts.defined).push_back(name);
        }
    }
}

}  // namespace

Result<ObjectFacts> look_at_object(std::string_view bytes, const std::string &file) {
    const auto header = read_at<Elf64_Ehdr>(bytes, 0);
    const bool is_elf = header && std::memcmp(header->e_ident, ELFMAG, SELFMAG) == 0 &&
                        header->e_ident[EI_CLASS] == ELFCLASS64 && header->e_shentsize == sizeof(Elf64_Shdr);
    if (!is_elf) {
        return fail(fmt::format("{} is not an object file of a 64-bit machine", file));
    }
    std::vector<Elf64_Shdr> sections;
    for (unsigned i = 0; i < header->e_shnum; ++i) {
        const auto section = read_at<Elf64_Shdr>(bytes, header->e_shoff + i * sizeof(Elf64_Shdr));
        if (!section) {
            return fail(fmt::format("{} is truncated", file));
        }
        sections.push_back(*section);
    }
    if (header->e_shstrndx >= sections.size()) {
        return fail(fmt::format("{} has no section names", file));
    }
    const auto content = [&](const Elf64_Shdr &section) {
        return part(bytes, section.sh_offset, section.sh_size);
    };
    const std::string_view section_names = content(sections[header->e_shstrndx]);
    ObjectFacts facts;
    for (const Elf64_Shdr &section : sections) {
        if (section.sh_type == SHT_SYMTAB && section.sh_link < sections.size()) {
            take_symbols(content(section), content(sections[section.sh_link]), facts);
        } else if (text_at(section_names, section.sh_name) == ".rtapi_export") {
            take_exports(content(section), facts);
        }
    }
    return facts;
}

}  // namespace mw::halcompile
