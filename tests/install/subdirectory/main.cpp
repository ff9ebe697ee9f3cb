#include <barchan/core/base/error.hpp>
#include <barchan/core/base/vec.hpp>

int main() {
  try {
    throw barchan::InputError("a wrong input", "a right one");
  } catch (const barchan::InputError& error) {
    const barchan::Vec3 zero = barchan::Vec3::Zero();
    return error.what() == nullptr || zero.norm() > 0.0 ? 1 : 0;
  }
}
