#include "tests/hal/parts/bus.hpp"

#include <cstdio>
#include <utility>

namespace hal::cortex_m {

// Declared here too: parts do not include the drivers' headers.
std::uint32_t answer_read(std::uintptr_t address, std::size_t size);
void answer_write(std::uintptr_t address, std::size_t size, std::uint32_t value);
void answer_shut_out(bool begins);

std::uint32_t answer_read(std::uintptr_t address, std::size_t size) {
  return parts::Bus::current().read(address, size);
}

void answer_write(std::uintptr_t address, std::size_t size, std::uint32_t value) {
  parts::Bus::current().write(address, size, value);
}

void answer_shut_out(bool begins) { parts::Bus::current().shut_out(begins); }

}  // namespace hal::cortex_m

namespace parts {

namespace {

Bus* newest = nullptr;

std::string in_hexadecimal(std::uintptr_t address) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%llx", static_cast<unsigned long long>(address));
  return text;
}

}  // namespace

Bus::Bus() { newest = this; }
Bus::~Bus() { newest = nullptr; }

Bus& Bus::current() {
  if (newest == nullptr) throw std::logic_error("a register was accessed without a bus");
  return *newest;
}

void Bus::attach(std::uintptr_t base, std::uint32_t size, Part& part, std::function<bool()> is_clocked) {
  places_.push_back({base, size, &part, std::move(is_clocked)});
}

const Bus::Place& Bus::at(std::uintptr_t address) const {
  for (const Place& place : places_)
    if (address >= place.base && address - place.base < place.size) return place;
  throw std::logic_error("nothing lies at " + in_hexadecimal(address) + ": a bus fault");
}

void Bus::pass_ns(double time_ns) {
  now_ns_ += time_ns;
  if (passing_ > 0) return;  // a part must not wait for itself
  ++passing_;
  for (const Place& place : places_)
    if (!place.is_clocked || place.is_clocked()) place.part->run(now_ns_);
  --passing_;
  take_interrupts();
}

void Bus::interrupt(unsigned number, const std::function<void()>& handler) { pending_[number] = handler; }

/// Pending interrupts run at the next access: guards end in destructors, which must not throw ChipReset.
void Bus::shut_out(bool begins) { shut_out_ += begins ? 1 : -1; }

void Bus::take_interrupts() {
  while (!pending_.empty() && shut_out_ == 0 && !interrupted_) {
    const std::function<void()> handler = pending_.begin()->second;
    pending_.erase(pending_.begin());
    interrupted_ = true;
    try {
      handler();
    } catch (...) {
      interrupted_ = false;
      throw;
    }
    interrupted_ = false;
  }
}

std::uint32_t Bus::read(std::uintptr_t address, std::size_t size) {
  const Place& place = at(address);
  pass_ns(access_ns_);
  if (place.is_clocked && !place.is_clocked()) return 0;
  const auto offset = static_cast<std::uint32_t>(address - place.base);
  const std::uint32_t word = place.part->read(offset & ~3u);
  return size == 4 ? word : word >> (offset & 3u) * 8 & 0xFF;
}

std::uint32_t Bus::read_by_dma(std::uintptr_t address) {
  const Place& place = at(address);
  if (place.is_clocked && !place.is_clocked()) return 0;
  return place.part->read(static_cast<std::uint32_t>(address - place.base));
}

void Bus::write(std::uintptr_t address, std::size_t size, std::uint32_t value) {
  const Place& place = at(address);
  pass_ns(access_ns_);
  if (place.is_clocked && !place.is_clocked()) return;
  const auto offset = static_cast<std::uint32_t>(address - place.base);
  if (size == 4) return place.part->write(offset, value);
  const unsigned shift = (offset & 3u) * 8;
  const std::uint32_t before = place.part->read(offset & ~3u);
  place.part->write(offset & ~3u, (before & ~(0xFFu << shift)) | (value & 0xFF) << shift);
}

void Bus::complain(const std::string& what) { complaints_.push_back(what); }

std::vector<std::string> Bus::take_complaints() { return std::exchange(complaints_, {}); }

}  // namespace parts
