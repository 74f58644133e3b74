// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <springfit/core/error.hpp>

namespace springfit::io {

/// Files that appear together or not at all.
///
/// Each file is first written in full under a temporary name in its own folder; `commit` flushes them all to the disk
/// and then renames them. Until then a file of the same name stays what it was. Whatever goes wrong (full disk,
/// unwritable folder, an exception elsewhere), no temporary is left behind, and files that were there before are there
/// again. What a killed process left is removed by the next one that writes the same file on the same machine.
///
///     OutputGroup outputs;
///     write_model(outputs, folder / "model.json", model);
///     write_report(outputs, folder / "report.json", report);
///     outputs.commit();
class OutputGroup {
public:
    OutputGroup() = default;
    OutputGroup(const OutputGroup&) = delete;
    OutputGroup& operator=(const OutputGroup&) = delete;
    ~OutputGroup() { discard(); }

    /// Creates the temporary file that will become `target`, empty, and returns its name. For libraries that write by
    /// themselves; they must have closed it before `commit`. Throws FileError naming `target`.
    [[nodiscard]] std::filesystem::path add(const std::filesystem::path& target);

    /// Writes all of `content` to the temporary file that will become `target`. Throws FileError naming `target`.
    void write(const std::filesystem::path& target, std::string_view content);

    /// A file that a run before left under this name, and this one does not write, goes when the others appear. None
    /// need be there.
    void remove(const std::filesystem::path& target);

    /// Gives every file its name, as one. Throws FileError naming the file that could not be written; then none is.
    void commit();

private:
    struct File {
        std::filesystem::path target;
        std::filesystem::path temporary; ///< empty: there is to be no such file
        std::filesystem::path backup;    ///< what had the name before, while the renaming is under way
        bool renamed = false;            ///< or removed
    };
    void flush() const;
    void back_up(File& file) const;
    void roll_back() noexcept;
    void discard() noexcept;

    std::vector<File> m_files;
};

/// Writes one file, in full or not at all. Throws FileError.
inline void write_file(const std::filesystem::path& target, std::string_view content) {
    OutputGroup outputs;
    outputs.write(target, content);
    outputs.commit();
}

/// The folder that results go to: created with its parents, and tried for writing before long work begins.
///
/// Folders that it created and that are still empty when it goes out of scope are removed again.
class OutputFolder {
public:
    /// Throws InvalidArgument for an empty name, FileError where `path` is a file, cannot be created or cannot be
    /// written to.
    explicit OutputFolder(std::filesystem::path path);
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;
    ~OutputFolder() { remove_empty(); }

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return m_path; }

private:
    void remove_empty() noexcept;

    std::filesystem::path m_path;
    std::vector<std::filesystem::path> m_created; ///< outermost first
};

} // namespace springfit::io

#include <springfit/io/detail/atomic_file_impl.hpp>
