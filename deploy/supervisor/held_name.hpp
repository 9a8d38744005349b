// A name that only one process of a domain's folders holds at a time. The kernel frees it with its last holder, also
// after SIGKILL, and leaves no file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace boresight::supervisor {

class HeldName {
 public:
  /// Nothing if another process holds the name. `folder` distinguishes domains in separate mount namespaces. Throws
  /// std::system_error if the folder is missing. A fork inherits the name and holds it, too; a program that it executes
  /// does not.
  [[nodiscard]] static std::optional<HeldName> take(const std::string& name, const std::filesystem::path& folder);
  ~HeldName();
  HeldName(HeldName&& other) noexcept;
  HeldName& operator=(HeldName&& other) noexcept;

  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  explicit HeldName(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace boresight::supervisor
