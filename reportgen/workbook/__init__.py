"""Read and write tables: CSV and XLSX become located cells, and are written so that no text becomes a formula.

`read` takes either; `write_csv` and `write_xlsx` return bytes that depend on their content alone.
"""

from reportgen.workbook.table_reading import read
from reportgen.workbook.table_writing import Book, Entry, WorksheetData, write_csv, write_xlsx
from reportgen.workbook.zip_package import Page, SheetCell

__all__ = ["Book", "Entry", "Page", "SheetCell", "WorksheetData", "read", "write_csv", "write_xlsx"]
