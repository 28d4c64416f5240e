"""Statistics: small frozen objects that turn a long frame into a table. They know nothing of studies or pages."""
