// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/io/model_json.hpp>
#include <springfit/io/motion_file.hpp>

int main() {
    try {
        (void)springfit::io::read_json("there-is-no-such-file.json");
    } catch (const springfit::FileError&) {
        return 0;
    }
    return 1;
}
