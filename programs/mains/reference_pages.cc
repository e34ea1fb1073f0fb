// SPDX-License-Identifier: GPL-2.0-or-later
// reference_pages FOLDER: writes the reference pages that are generated from declarations: ini.md,
// messages.md, nml_messages.md, published.md and task/states.md. A tool of the build, not installed.
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/atomic_file.hh"
#include "clients/nml/message/wire_table.hh"
#include "clients/publish/assembly/ini_keys.hh"
#include "clients/publish/table.hh"
#include "clients/shop/assembly/ini_keys.hh"
#include "machine/config/ini_keys.hh"
#include "machine/task/run/admission.hh"
#include "messages/declarations/reference.hh"

int main(int count, char **words) {
    if (count != 2 || words[1][0] == '-') {
        const bool is_help = count == 2 && std::string(words[1]) == "--help";
        std::fputs("usage: reference_pages FOLDER\n", is_help ? stdout : stderr);
        return is_help ? 0 : 2;
    }
    const std::string folder = words[1];
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    std::vector<mw::ini::IniKey> of_clients(mw::publish::PUBLISH_KEYS.begin(),
                                            mw::publish::PUBLISH_KEYS.end());
    of_clients.insert(of_clients.end(), mw::shop::SHOP_KEYS.begin(), mw::shop::SHOP_KEYS.end());
    const std::pair<const char *, std::string> pages[] = {{"ini.md", mw::machine::ini_reference(of_clients)},
                                                          {"messages.md", mw::messages::reference_page()},
                                                          {"nml_messages.md", mw::nml::nml_reference_page()},
                                                          {"published.md", mw::publish::published_page()},
                                                          {"states.md", mw::task::states_page()}};
    for (const auto &[name, text] : pages) {
        if (const auto written = mw::write_file_atomically(folder + '/' + name, text); !written.has_value()) {
            std::fprintf(stderr, "%s\n", written.error().message.c_str());
            return 1;
        }
    }
    return 0;
}
