// What many cells want and one of them makes, as the run of a reference: whoever asks for it meanwhile waits.
#pragma once

#include <map>
#include <mutex>
#include <string>

namespace jvari::bench::store {

template <class Value>
class Memo {
public:
    template <class Make>
    const Value& get(const std::string& key, Make make) {  // what `make` throws is thrown on, and the next who asks makes it
        Each& each = of(key);
        std::call_once(each.once, [&] { each.value = make(); });
        return each.value;
    }

private:
    struct Each {
        std::once_flag once;
        Value value{};
    };
    Each& of(const std::string& key) {
        const std::lock_guard lock(mutex_);
        return all_[key];
    }
    std::mutex mutex_;  // of `all_`
    std::map<std::string, Each> all_;
};

}  // namespace jvari::bench::store
