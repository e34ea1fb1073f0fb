// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/language/language.hh"

#include <dlfcn.h>
#include <link.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace mw::language {
namespace {

/// "de_AT.UTF-8@euro" as "de_AT".
std::string without_codeset(std::string_view locale) {
    return std::string(locale.substr(0, locale.find_first_of(".@")));
}

bool isEnglish(std::string_view locale) {
    return locale == "C" || locale == "POSIX" || locale.starts_with("en");
}

/// The folder of the file that contains this code: a program, or a module of Python or Tcl. The loader knows
/// a program only by the name that started it, which may not be its path, so the system is asked.
std::string own_folder() {
    Dl_info info{};
    void *object = nullptr;
    char path[4096];
    const bool known =
        ::dladdr1(reinterpret_cast<const void *>(&own_folder), &info, &object, RTLD_DL_LINKMAP) != 0;
    const auto *map = static_cast<const link_map *>(object);
    const bool is_program = !known || map->l_name == nullptr || map->l_name[0] == '\0';
    if (::realpath(is_program ? "/proc/self/exe" : map->l_name, path) == nullptr) {
        return ".";
    }
    const std::string_view file(path);
    return std::string(file.substr(0, file.rfind('/')));
}

std::string bytes_of(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Catalogue read_wanted() {
    const std::vector<std::string> names = wanted([](const char *name) { return std::getenv(name); });
    for (const std::string &name : names) {
        std::string up = own_folder();
        for (int level = 0; level < 5; ++level, up += "/..") {
            const std::string path = up + "/share/locale/" + name + "/LC_MESSAGES/millwright.mo";
            const std::string bytes = bytes_of(path);
            if (bytes.empty()) {
                continue;
            }
            if (auto read = Catalogue::read(bytes)) {
                return *std::move(read);
            } else {
                std::fprintf(stderr, "%s: %s\n", path.c_str(), read.error().message.c_str());
                return {};
            }
        }
    }
    return {};
}

}  // namespace

std::vector<std::string> wanted(const std::function<const char *(const char *)> &get) {
    std::string_view locale;
    for (const char *name : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
        const char *value = get(name);
        if (value != nullptr && *value != '\0') {
            locale = value;
            break;
        }
    }
    const std::string plain = without_codeset(locale);
    if (plain.empty() || plain == "C" || plain == "POSIX") {
        return {};
    }
    const char *list = get("LANGUAGE");
    std::string_view rest =
        list != nullptr && *list != '\0' ? std::string_view(list) : std::string_view(plain);
    std::vector<std::string> found;
    while (!rest.empty()) {
        const std::size_t end = rest.find(':');
        const std::string name = without_codeset(rest.substr(0, end));
        rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
        if (isEnglish(name)) {
            break;  // English needs no catalogue
        }
        if (name.empty() || name.find('/') != std::string::npos) {
            continue;
        }
        found.push_back(name);
        if (const std::size_t country = name.find('_'); country != std::string::npos) {
            found.push_back(name.substr(0, country));
        }
    }
    return found;
}

const Catalogue &catalogue() {
    static const Catalogue read = read_wanted();
    return read;
}

std::string shown(std::string_view english) {
    return catalogue().shown(english);
}

void tell(std::string_view english) {
    const std::string line = shown(english) + '\n';
    std::fwrite(line.data(), 1, line.size(), stderr);
}

void tell(std::string_view program, const Error &error) {
    tell(std::string(program) + ": " + error.str());
}

}  // namespace mw::language
