#pragma once

#include <functional>
#include <string>

#include <barchan/comm/base/communicator.hpp>

namespace barchan {

/// Does `work` on every rank, and throws on every rank what the lowest rank threw on which it
/// failed.
///
/// For work that is local but may go well on one rank and not on another: reading, writing. So
/// nobody waits for a rank that threw. @pre `work` calls nothing that is collective. Collective.
/// Errors: InputError as thrown; all else as CommonError.
void agree(const Communicator& communicator, const std::function<void()>& work);

/// The same for work of a caller's between two steps.
/// @param where  such as "step 7: on_note". Errors: AgreedError that names the rank
void agree_between_steps(const Communicator& communicator, const std::string& where,
                         const std::function<void()>& work);

}  // namespace barchan
