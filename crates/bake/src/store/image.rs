//! Names of the images of tables.

/// The first bytes of every OpenEXR file.
pub(super) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Names of images end with this.
const EXTENSION: &str = ".exr";

/// The name of the image of a table, if a file can be named so.
pub(super) fn name_of(table: &str) -> Option<String> {
    let name = format!("{table}{EXTENSION}");
    table_of(&name).is_some().then_some(name)
}

/// The name of the table that an image of this name would hold.
pub(super) fn table_of(name: &str) -> Option<&str> {
    let table = name.strip_suffix(EXTENSION)?;
    let is_plain = |c: char| !c.is_control() && c != '/' && c != '\\';
    (!table.is_empty() && !table.starts_with('.') && table.chars().all(is_plain)).then_some(table)
}
