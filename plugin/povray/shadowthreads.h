// SPDX-License-Identifier: AGPL-3.0-or-later
// Work on many things that do not depend on each other, shared among threads.

#ifndef POVRAY_BACKEND_SHADOWTHREADS_H
#define POVRAY_BACKEND_SHADOWTHREADS_H

#include <new>

#include <boost/bind.hpp>
#include <boost/thread.hpp>

namespace pov
{

/// Calls work(0), work(1), ... work(count - 1), each once and in any order.
template<class Work>
class ShadowShare
{
	public:
		/// In the calling thread, and in so many others that they are `threads` together; in fewer if the system gives no more.
		/// @throw      std::bad_alloc      if a call did; some calls are not made then
		ShadowShare(unsigned int threads, size_t c, const Work& w) : count(c), work(w), next(0), failed(0)
		{
			boost::thread_group others;

			for(unsigned int i = 1; (i < threads) && (i < count); i++)
				if(!Hire(others))
					break;
			Take();
			others.join_all();
			if(failed != 0)
				throw std::bad_alloc();
		}
	private:
		const size_t count;
		const Work& work;
		size_t next;
		int failed; ///< only ever set, and read when the others are gone

		bool Hire(boost::thread_group& others)
		{
			try
			{
				others.create_thread(boost::bind(&ShadowShare::Take, this));
				return true;
			}
			catch(std::exception&)
			{
				return false;
			}
		}

		void Take()
		{
			try
			{
				for(size_t i = __sync_fetch_and_add(&next, 1); i < count; i = __sync_fetch_and_add(&next, 1))
					work(i);
			}
			catch(std::bad_alloc&)
			{
				__sync_fetch_and_or(&failed, 1);
			}
		}
};

template<class Work>
void ShareWork(unsigned int threads, size_t count, const Work& work)
{
	ShadowShare<Work>(threads, count, work);
}

}

#endif
