// SPDX-License-Identifier: GPL-2.0-or-later
// Password files: a line "name:password" for each user; a line with # is a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::nml {

struct Credentials {
    std::string name;
    std::string password;
};

class Passwords {
  public:
    /// An error if the file cannot be read, users other than its owner may read it, or a line is wrong.
    static Result<Passwords> load(const std::string &path);

    /// Takes the same time for each wrong password.
    bool isRight(std::string_view name, std::string_view password) const;
    /// The first line, with which a client logs in.
    const Credentials &first() const { return users_.front(); }

  private:
    std::vector<Credentials> users_;  ///< has at least one entry
};

}  // namespace mw::nml
