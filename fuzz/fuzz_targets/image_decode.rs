//! Pictures: PNG, JPEG, HDR and EXR, told apart by their content, within limits that keep one small.
//!
//! The decoder catches panics of the EXR library at its one door, so a panic counts here only where it comes out.
#![no_main]

use snell_image::{Limits, decode};

libfuzzer_sys::fuzz_target!(
    init: {
        std::panic::set_hook(Box::new(|_| {}));
    },
    |bytes: &[u8]| {
        let limits = Limits { max_width: 4096, max_height: 4096, max_bytes: 1 << 28 };
        if let Ok(picture) = decode(bytes, &limits) {
            let (width, height) = picture.image.size();
            assert!(width <= limits.max_width && height <= limits.max_height);
            assert_eq!(picture.image.pixels().len(), width as usize * height as usize);
        }
    }
);
