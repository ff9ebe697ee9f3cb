#pragma once

#include <memory>

#include <barchan/comm/slots/slot_exchange.hpp>

// One factory per exchange, each defined in the file of its name; make_exchange.cpp lists them.

namespace barchan {

std::unique_ptr<SlotExchange> make_put_flag(const Communicator& communicator,
                                            const Neighbours& neighbours);
std::unique_ptr<SlotExchange> make_put_inband(const Communicator& communicator,
                                              const Neighbours& neighbours);
std::unique_ptr<SlotExchange> make_get(const Communicator& communicator,
                                       const Neighbours& neighbours);
std::unique_ptr<SlotExchange> make_shared_memory(const Communicator& communicator,
                                                 const Neighbours& neighbours);
std::unique_ptr<SlotExchange> make_pscw(const Communicator& communicator,
                                        const Neighbours& neighbours);
std::unique_ptr<SlotExchange> make_fence(const Communicator& communicator,
                                         const Neighbours& neighbours);
std::unique_ptr<SlotExchange> make_isend(const Communicator& communicator,
                                         const Neighbours& neighbours);
std::unique_ptr<SlotExchange> make_sendrecv(const Communicator& communicator,
                                            const Neighbours& neighbours);

}  // namespace barchan
