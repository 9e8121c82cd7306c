//! Builds only if `microfacet-sampler` without default features does not link the standard library,
//! whose panic handler would clash with this one.
#![no_std]

use core::alloc::{GlobalAlloc, Layout};
use core::panic::PanicInfo;

use microfacet_sampler::Tables;

struct NoMemory;

// SAFETY: returning null is how an allocator says that it has no memory; nothing is ever freed.
unsafe impl GlobalAlloc for NoMemory {
    unsafe fn alloc(&self, _: Layout) -> *mut u8 {
        core::ptr::null_mut()
    }
    unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
}

#[global_allocator]
static ALLOCATOR: NoMemory = NoMemory;

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    loop {}
}

/// Keeps the crate's code in the library.
#[unsafe(no_mangle)]
pub extern "C" fn covers_ggx(bytes: &[u8; 64]) -> bool {
    Tables::from_bytes(bytes).is_ok_and(|tables| tables.covers(2.0))
}
