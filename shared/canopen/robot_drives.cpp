#include "shared/canopen/robot_drives.h"

#include <any>

namespace tenon {

const CanopenDrive& canopen_drive(const Joint& joint) {
  static const CanopenDrive kByTheBook;
  const auto* drive = std::any_cast<CanopenDrive>(&joint.drive);
  return drive == nullptr ? kByTheBook : *drive;
}

CanopenDrive& canopen_drive(Joint& joint) {
  auto* drive = std::any_cast<CanopenDrive>(&joint.drive);
  return drive == nullptr ? joint.drive.emplace<CanopenDrive>() : *drive;
}

}  // namespace tenon
